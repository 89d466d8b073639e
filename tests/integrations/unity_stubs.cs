// What the package's scripts use of Unity, so that they can be compiled without it, and a program that calls the
// plugin through them: it prints the sizes of structs as C# has them, and with the plugin's stub (unity_stub.c) makes,
// draws and releases canvases.
using System;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    public struct Color
    {
        public float r, g, b, a;
        public Color(float r, float g, float b, float a) { this.r = r; this.g = g; this.b = b; this.a = a; }
        public static Color clear { get { return new Color(); } }
        public static Color white { get { return new Color { r = 1, g = 1, b = 1, a = 1 }; } }
        public Color linear { get { return this; } }
    }

    public struct Rect
    {
        public Rect(float x, float y, float width, float height) { }
    }

    public class Object { public string name; }
    public class Texture : Object
    {
        public int asked, made;
        public IntPtr GetNativeTexturePtr() { ++asked; return new IntPtr(made); }
    }
    public class RenderTexture : Texture
    {
        public bool enableRandomWrite;
        public RenderTexture(int width, int height, int depth, Experimental.Rendering.GraphicsFormat format) { }
        bool created;
        public static int Released;
        public bool Create() { created = true; ++made; return true; }
        public bool IsCreated() { return created; }
        public void Release() { created = false; ++Released; }
    }
    public class Material : Object { }
    public class Font : Object { } // names that the package has, too: its own are found first
    public class Canvas : Object { }
    public class TextAsset : Object { public byte[] bytes { get { return null; } } }
    public class MonoBehaviour : Object { public bool enabled; }

    public class AddComponentMenu : Attribute { public AddComponentMenu(string menuName) { } }
    public class TooltipAttribute : Attribute { public TooltipAttribute(string tooltip) { } }

    public static class Debug
    {
        public static void LogError(object message, Object context) { }
        public static void LogWarning(object message, Object context) { }
    }
    public static class Mathf
    {
        public static float Min(float a, float b) { return Math.Min(a, b); }
    }
    public enum ColorSpace { Gamma, Linear }
    public static class QualitySettings { public static ColorSpace activeColorSpace { get { return ColorSpace.Linear; } } }
    public static class Graphics
    {
        public static void ExecuteCommandBuffer(Rendering.CommandBuffer buffer) { }
        public static void DrawTexture(Rect screenRect, Texture texture, Material material) { }
    }
    public enum EventType { Repaint }
    public class Event
    {
        public static Event current { get { return new Event(); } }
        public EventType type;
    }
}

namespace UnityEngine.Rendering
{
    public class CommandBuffer
    {
        public string name;
        public static int Released;
        public void IssuePluginEventAndData(IntPtr callback, int eventID, IntPtr data) { }
        public void Release() { ++Released; }
    }
}

namespace UnityEngine.Experimental.Rendering
{
    public enum GraphicsFormat { R8G8B8A8_UNorm }
}

static class Program
{
    static void Need(bool holds, string what)
    {
        if (!holds) throw new Exception(what);
    }

    /// Whatever way it goes, texture and command buffer go with a canvas, once.
    static void CanvasesRelease()
    {
        using (new Gpgp.Canvas(8, 8)) { }
        var canvas = new Gpgp.Canvas(8, 8);
        ((IDisposable)canvas).Dispose();
        canvas.Dispose();
        Gpgp.NativeObject some = new Gpgp.Canvas(8, 8);
        some.Dispose();
        Need(UnityEngine.RenderTexture.Released == 3, "textures are released");
        Need(UnityEngine.Rendering.CommandBuffer.Released == 3, "command buffers are released");
    }

    /// The pointer is asked for only where the texture is a new one, and drawing makes no garbage.
    static void CanvasesKeepWhatTheyAskedFor()
    {
        using (var canvas = new Gpgp.Canvas(8, 8))
        using (var drawing = Gpgp.Drawing.FromSvg(new byte[1]))
        {
            for (int i = 0; i < 10; ++i) Draw(canvas, drawing);
            var told = drawing.Box;
            Need(told[0] == 1 && told[1] == 20 && told[2] == 0.5f && told[3] == 0.25f, "what the plugin is told");
            Need(canvas.Texture.asked == 1, "asked for the pointer once");
            canvas.Texture.Release(); // as Unity loses it
            Draw(canvas, drawing);
            Draw(canvas, drawing);
            Need(drawing.Box[0] == 2, "the new texture is handed over");
            Need(canvas.Texture.asked == 2 && canvas.Texture.IsCreated(), "asked again for a new texture");
            canvas.Refresh();
            Need(canvas.Texture.asked == 3, "asked again where one says so");
            var collections = GC.CollectionCount(0);
            for (int i = 0; i < 400000; ++i) Draw(canvas, drawing);
            Need(GC.CollectionCount(0) == collections, "no garbage");
        }
    }

    static void Draw(Gpgp.Canvas canvas, Gpgp.Drawing drawing)
    {
        canvas.Background = new UnityEngine.Color(1, 1, 1, 0.25f);
        canvas.Clear();
        for (int i = 0; i < 20; ++i) canvas.Add(drawing, 0, 0, 1, i == 19 ? 0.5f : 1);
        canvas.Draw();
        if (drawing.Box.Length != 4 || Gpgp.Plugin.TakeMessages().Length > 0) throw new Exception("messages");
    }

    static int Main()
    {
        Console.WriteLine("{0} {1} {2} {3}", Marshal.SizeOf(typeof(Gpgp.Native.Budgets)),
                          Marshal.SizeOf(typeof(Gpgp.Native.TextInfo)), Marshal.SizeOf(typeof(Gpgp.Native.Item)),
                          Marshal.SizeOf(typeof(Gpgp.Native.CanvasInfo)));
        if (Gpgp.Plugin.Ready) // the plugin's stub
        {
            CanvasesRelease();
            CanvasesKeepWhatTheyAskedFor();
            return 0;
        } // else no Unity, no device: but the plugin answers
        try
        {
            Gpgp.Drawing.FromSvg(new byte[] { 1, 2, 3 });
        }
        catch (Gpgp.GpgpException)
        {
            return 0;
        }
        return 1;
    }
}
