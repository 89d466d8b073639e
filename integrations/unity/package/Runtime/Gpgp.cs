// The functions of the native plugin, as gpgp_unity.h documents them, and drawings, fonts and texts as objects.
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Gpgp
{
    internal static class Native
    {
        const string Library = "gpgp_unity";

        [StructLayout(LayoutKind.Sequential)]
        internal struct Budgets
        {
            public uint maxWidth, maxHeight, maxTileEntries, maxPaths, maxGlyphs, maxItems, maxShapes;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct TextInfo
        {
            public IntPtr text;
            public int size;
            public int font;
            public float pixels;
            [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public float[] color;
            public float width;
            public int align;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct Item
        {
            public int obj;
            public float t0, t1, t2, t3, t4, t5;
            public float opacity;
        }

        [StructLayout(LayoutKind.Sequential)]
        internal struct CanvasInfo
        {
            public IntPtr texture;
            public uint flags;
            public float red, green, blue, alpha; // of the background
            public IntPtr items;
            public int itemCount;
        }

        internal const uint Flip = 1, EncodeSrgb = 2;

        [DllImport(Library)] internal static extern int gpgpUnityGetState();
        [DllImport(Library)] internal static extern int gpgpUnityTakeMessage(byte[] text, int capacity);
        [DllImport(Library)] internal static extern IntPtr gpgpUnityGetEvent();
        [DllImport(Library)] internal static extern int gpgpUnityGetEventId();
        [DllImport(Library)] internal static extern int gpgpUnitySetBudgets(ref Budgets budgets);
        [DllImport(Library)] internal static extern int gpgpUnityCreateDrawing(byte[] data, int size, int baked);
        [DllImport(Library)] internal static extern int gpgpUnityGetBox(int obj, float[] box);
        [DllImport(Library)] internal static extern int gpgpUnityCreateFont(byte[] data, int size);
        [DllImport(Library)] internal static extern int gpgpUnitySetFallbacks(int font, int[] fallbacks, int count);
        [DllImport(Library)] internal static extern int gpgpUnityCreateText(ref TextInfo text);
        [DllImport(Library)] internal static extern int gpgpUnitySetText(int obj, ref TextInfo text);
        [DllImport(Library)] internal static extern int gpgpUnityCreateCanvas();
        [DllImport(Library)] internal static extern int gpgpUnitySetCanvas(int canvas, ref CanvasInfo info);
        [DllImport(Library)] internal static extern void gpgpUnityDestroy(int obj);
    }

    /// <summary>What the plugin said when a call failed.</summary>
    public sealed class GpgpException : Exception
    {
        internal GpgpException(string message) : base(message) { }
    }

    /// <summary>The plugin as a whole.</summary>
    public static class Plugin
    {
        /// <summary>Whether Unity renders with Vulkan and the plugin was loaded on startup.</summary>
        public static bool Ready { get { return Native.gpgpUnityGetState() == 1; } }

        static readonly byte[] bytes = new byte[1024];
        static readonly List<string> taken = new List<string>();
        static readonly string[] none = new string[0];

        /// <summary>Messages since the last call, oldest first. No garbage where there are none.</summary>
        public static string[] TakeMessages()
        {
            taken.Clear();
            for (int length; (length = Native.gpgpUnityTakeMessage(bytes, bytes.Length)) > 0;)
                taken.Add(Encoding.UTF8.GetString(bytes, 0, Math.Min(length, bytes.Length - 1)));
            return taken.Count > 0 ? taken.ToArray() : none;
        }

        /// <summary>Larger canvases, or more on them. Makes pipelines: while a level loads. 0: the default.</summary>
        public static void SetBudgets(uint maxWidth, uint maxHeight, uint maxTileEntries = 0, uint maxPaths = 0,
                                      uint maxGlyphs = 0, uint maxItems = 0, uint maxShapes = 0)
        {
            var budgets = new Native.Budgets
            {
                maxWidth = maxWidth,
                maxHeight = maxHeight,
                maxTileEntries = maxTileEntries,
                maxPaths = maxPaths,
                maxGlyphs = maxGlyphs,
                maxItems = maxItems,
                maxShapes = maxShapes
            };
            Need(Native.gpgpUnitySetBudgets(ref budgets), "gpgpUnitySetBudgets");
        }

        internal static int Need(int result, string call)
        {
            if (result >= 0) return result;
            var messages = TakeMessages();
            throw new GpgpException(messages.Length > 0 ? string.Join("\n", messages) : call + " returned " + result);
        }
    }

    /// <summary>Something in the plugin with a number, until it is disposed.</summary>
    public abstract class NativeObject : IDisposable
    {
        internal int Number { get; private set; }

        internal NativeObject(int number) { Number = number; }

        public virtual void Dispose()
        {
            if (Number > 0) Native.gpgpUnityDestroy(Number);
            Number = 0;
        }
    }

    /// <summary>What a canvas shows.</summary>
    public abstract class Shape : NativeObject
    {
        readonly float[] box = new float[4];

        internal Shape(int number) : base(number) { }

        /// <summary>x, y, width, height: a drawing's page, a text's box. Y points down. The same array each time.
        /// </summary>
        public float[] Box
        {
            get
            {
                Plugin.Need(Native.gpgpUnityGetBox(Number, box), "gpgpUnityGetBox");
                return box;
            }
        }
    }

    public sealed class Drawing : Shape
    {
        Drawing(int number) : base(number) { }

        /// <summary>From the bytes of an SVG file. Takes a while for large ones: bake those.</summary>
        public static Drawing FromSvg(byte[] bytes) { return Make(bytes, 0); }

        /// <summary>From the bytes of a baked drawing, as `gpgp bake` writes it.</summary>
        public static Drawing FromBaked(byte[] bytes) { return Make(bytes, 1); }

        static Drawing Make(byte[] bytes, int baked)
        {
            return new Drawing(
                Plugin.Need(Native.gpgpUnityCreateDrawing(bytes, bytes.Length, baked), "gpgpUnityCreateDrawing"));
        }
    }

    public sealed class Font : NativeObject
    {
        /// <summary>From the bytes of a TTF, OTF or TTC file.</summary>
        public Font(byte[] bytes)
            : base(Plugin.Need(Native.gpgpUnityCreateFont(bytes, bytes.Length), "gpgpUnityCreateFont")) { }

        /// <summary>Fonts for what this one does not have, asked in their order: other scripts, emoji. They count for
        /// texts that are set from now on, and must not be disposed before those texts.</summary>
        public void SetFallbacks(params Font[] fallbacks)
        {
            var numbers = Array.ConvertAll(fallbacks, font => font.Number);
            Plugin.Need(Native.gpgpUnitySetFallbacks(Number, numbers, numbers.Length), "gpgpUnitySetFallbacks");
        }
    }

    public enum TextAlign { Start = 0, End = 1, Left = 2, Center = 3, Right = 4, Justify = 5 }

    public sealed class Text : Shape
    {
        /// <summary>color: linear red, green, blue, straight alpha. width 0: lines end where the text says.</summary>
        public Text(Font font, string text, float pixels, float[] color, float width = 0,
                    TextAlign align = TextAlign.Start)
            : base(Call(0, font, text, pixels, color, width, align)) { }

        public void Set(Font font, string text, float pixels, float[] color, float width = 0,
                        TextAlign align = TextAlign.Start)
        {
            Call(Number, font, text, pixels, color, width, align);
        }

        static int Call(int number, Font font, string text, float pixels, float[] color, float width, TextAlign align)
        {
            if (color == null || color.Length != 4) throw new ArgumentException("a colour has four components");
            var bytes = Encoding.UTF8.GetBytes(text);
            var pinned = GCHandle.Alloc(bytes, GCHandleType.Pinned);
            try
            {
                var info = new Native.TextInfo
                {
                    text = bytes.Length > 0 ? pinned.AddrOfPinnedObject() : IntPtr.Zero,
                    size = bytes.Length,
                    font = font.Number,
                    pixels = pixels,
                    color = color,
                    width = width,
                    align = (int)align
                };
                return number == 0
                    ? Plugin.Need(Native.gpgpUnityCreateText(ref info), "gpgpUnityCreateText")
                    : Plugin.Need(Native.gpgpUnitySetText(number, ref info), "gpgpUnitySetText");
            }
            finally
            {
                pinned.Free();
            }
        }
    }
}
