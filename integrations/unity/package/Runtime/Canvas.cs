// A canvas in a render texture.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using UnityEngine;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering;

namespace Gpgp
{
    /// <summary>Shapes, rasterised into a render texture of its own. Colours in it are premultiplied by alpha.</summary>
    public sealed class Canvas : NativeObject
    {
        readonly List<Native.Item> items = new List<Native.Item>();
        readonly CommandBuffer commands = new CommandBuffer { name = "gpgp canvas" };

        public RenderTexture Texture { get; private set; }
        public Color Background = Color.clear;

        public Canvas(int width, int height) : base(Plugin.Need(Native.gpgpUnityCreateCanvas(), "gpgpUnityCreateCanvas"))
        {
            Texture = new RenderTexture(width, height, 0, GraphicsFormat.R8G8B8A8_UNorm)
            {
                enableRandomWrite = true, // gpgp writes it as a storage image
                name = "gpgp canvas"
            };
            Texture.Create();
            commands.IssuePluginEventAndData(Native.gpgpUnityGetEvent(), Native.gpgpUnityGetEventId(),
                                             new IntPtr(Number));
        }

        /// <summary>Begins anew; the next Add is at the bottom.</summary>
        public void Clear() { items.Clear(); }

        /// <summary>Puts a shape's origin at (x, y) in pixels from the upper left corner.</summary>
        public void Add(Shape shape, float x, float y, float scale = 1, float opacity = 1)
        {
            items.Add(new Native.Item { obj = shape.Number, t0 = scale, t3 = scale, t4 = x, t5 = y, opacity = opacity });
        }

        /// <summary>Once a frame in which it is to be drawn: hands the shapes over and has them recorded.</summary>
        public void Draw()
        {
            var list = items.ToArray();
            var pinned = GCHandle.Alloc(list, GCHandleType.Pinned);
            try
            {
                var linear = QualitySettings.activeColorSpace == ColorSpace.Linear;
                var background = linear ? Background.linear : Background;
                var info = new Native.CanvasInfo
                {
                    texture = Texture.GetNativeTexturePtr(),
                    flags = Native.Flip | (linear ? 0 : Native.EncodeSrgb),
                    background = new[]
                    {
                        background.r * background.a, background.g * background.a, background.b * background.a,
                        background.a
                    },
                    items = list.Length > 0 ? pinned.AddrOfPinnedObject() : IntPtr.Zero,
                    itemCount = list.Length
                };
                Plugin.Need(Native.gpgpUnitySetCanvas(Number, ref info), "gpgpUnitySetCanvas");
            }
            finally
            {
                pinned.Free();
            }
            Graphics.ExecuteCommandBuffer(commands);
        }

        /// <summary>The texture goes, too.</summary>
        public new void Dispose()
        {
            base.Dispose(); // events that are under way find no canvas any more
            commands.Release();
            if (Texture != null) Texture.Release();
            Texture = null;
        }
    }
}
