// A canvas in a render texture.
using System;
using System.Runtime.InteropServices;
using UnityEngine;
using UnityEngine.Experimental.Rendering;
using UnityEngine.Rendering;

namespace Gpgp
{
    /// <summary>Shapes, rasterised into a render texture of its own. Colours in it are premultiplied by alpha.</summary>
    public sealed class Canvas : NativeObject
    {
        Native.Item[] items = new Native.Item[16];
        int itemCount;
        readonly CommandBuffer commands = new CommandBuffer { name = "gpgp canvas" };
        IntPtr native; // the texture's: asking for it waits for the render thread

        public RenderTexture Texture { get; private set; }
        public Color Background = Color.clear;

        public Canvas(int width, int height) : base(Plugin.Need(Native.gpgpUnityCreateCanvas(), "gpgpUnityCreateCanvas"))
        {
            Texture = new RenderTexture(width, height, 0, GraphicsFormat.R8G8B8A8_UNorm)
            {
                enableRandomWrite = true, // gpgp writes it as a storage image
                name = "gpgp canvas"
            };
            Refresh();
            commands.IssuePluginEventAndData(Native.gpgpUnityGetEvent(), Native.gpgpUnityGetEventId(),
                                             new IntPtr(Number));
        }

        /// <summary>After the texture was released and created by others, with another size for example. A texture that
        /// Unity has lost is created again by Draw.</summary>
        public void Refresh()
        {
            if (!Texture.IsCreated()) Texture.Create();
            native = Texture.GetNativeTexturePtr();
        }

        /// <summary>Begins anew; the next Add is at the bottom.</summary>
        public void Clear() { itemCount = 0; }

        /// <summary>Puts a shape's origin at (x, y) in pixels from the upper left corner.</summary>
        public void Add(Shape shape, float x, float y, float scale = 1, float opacity = 1)
        {
            if (itemCount == items.Length) Array.Resize(ref items, 2 * itemCount);
            items[itemCount++] =
                new Native.Item { obj = shape.Number, t0 = scale, t3 = scale, t4 = x, t5 = y, opacity = opacity };
        }

        /// <summary>Once a frame in which it is to be drawn: hands the shapes over and has them recorded. Makes no
        /// garbage.</summary>
        public void Draw()
        {
            if (!Texture.IsCreated()) Refresh();
            var linear = QualitySettings.activeColorSpace == ColorSpace.Linear;
            var background = linear ? Background.linear : Background;
            var pinned = GCHandle.Alloc(items, GCHandleType.Pinned);
            try
            {
                var info = new Native.CanvasInfo
                {
                    texture = native,
                    flags = Native.Flip | (linear ? 0 : Native.EncodeSrgb),
                    red = background.r * background.a,
                    green = background.g * background.a,
                    blue = background.b * background.a,
                    alpha = background.a,
                    items = itemCount > 0 ? pinned.AddrOfPinnedObject() : IntPtr.Zero,
                    itemCount = itemCount
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
        public override void Dispose()
        {
            base.Dispose(); // events that are under way find no canvas any more
            if (Texture == null) return;
            commands.Release();
            Texture.Release();
            Texture = null;
        }
    }
}
