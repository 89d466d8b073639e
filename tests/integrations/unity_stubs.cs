// What the package's scripts use of Unity, so that they can be compiled without it, and a program that calls the
// plugin through them: it prints the sizes of structs as C# has them.
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
        public IntPtr GetNativeTexturePtr() { return IntPtr.Zero; }
    }
    public class RenderTexture : Texture
    {
        public bool enableRandomWrite;
        public RenderTexture(int width, int height, int depth, Experimental.Rendering.GraphicsFormat format) { }
        public bool Create() { return true; }
        public void Release() { }
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
        public void IssuePluginEventAndData(IntPtr callback, int eventID, IntPtr data) { }
        public void Release() { }
    }
}

namespace UnityEngine.Experimental.Rendering
{
    public enum GraphicsFormat { R8G8B8A8_UNorm }
}

static class Program
{
    static int Main()
    {
        Console.WriteLine("{0} {1} {2} {3}", Marshal.SizeOf(typeof(Gpgp.Native.Budgets)),
                          Marshal.SizeOf(typeof(Gpgp.Native.TextInfo)), Marshal.SizeOf(typeof(Gpgp.Native.Item)),
                          Marshal.SizeOf(typeof(Gpgp.Native.CanvasInfo)));
        if (Gpgp.Plugin.Ready) return 1; // no Unity, no device: but the plugin answers
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
