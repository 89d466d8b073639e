// A component that shows a drawing and a text.
using System;
using UnityEngine;

namespace Gpgp
{
    /// <summary>An SVG and a line of text in a render texture, drawn every frame, on the screen if wanted.</summary>
    [AddComponentMenu("gpgp/Canvas")]
    public sealed class CanvasComponent : MonoBehaviour
    {
        [Tooltip("An SVG file with the ending .bytes")] public TextAsset svg;
        [Tooltip("A font file with the ending .bytes")] public TextAsset font;
        [Tooltip("Fonts for what it does not have: other scripts, emoji")] public TextAsset[] fallbacks;
        public string text = "";
        public float textPixels = 32;
        public Color textColor = Color.white;
        public int width = 512, height = 512;
        [Tooltip("Shows the texture in a corner of the screen")] public bool onScreen = true;
        [Tooltip("Blends premultiplied colours: gpgp/Premultiplied")] public Material material;

        Canvas canvas;
        Drawing drawing;
        Font openFont;
        Font[] openFallbacks = new Font[0];
        Text line;

        /// <summary>For materials; null until the plugin is ready.</summary>
        public RenderTexture Texture { get { return canvas == null ? null : canvas.Texture; } }

        void OnEnable()
        {
            if (!Plugin.Ready)
            {
                foreach (var message in Plugin.TakeMessages()) Debug.LogError(message, this);
                Debug.LogError("gpgp needs Vulkan, and its plugin loaded on startup", this);
                enabled = false;
                return;
            }
            canvas = new Canvas(width, height);
            if (svg != null) drawing = Drawing.FromSvg(svg.bytes);
            if (font != null)
            {
                openFont = new Font(font.bytes);
                if (fallbacks != null) openFallbacks = Array.ConvertAll(fallbacks, file => new Font(file.bytes));
                openFont.SetFallbacks(openFallbacks);
                var color = textColor.linear;
                line = new Text(openFont, text, textPixels, new[] { color.r, color.g, color.b, color.a }, width);
            }
        }

        void Update()
        {
            foreach (var message in Plugin.TakeMessages()) Debug.LogWarning(message, this);
            canvas.Clear();
            if (drawing != null)
            {
                var page = drawing.Box;
                var scale = Mathf.Min(width / page[2], height / page[3]);
                canvas.Add(drawing, -page[0] * scale, -page[1] * scale, scale);
            }
            if (line != null) canvas.Add(line, 0, height - line.Box[3]);
            canvas.Draw();
        }

        void OnGUI()
        {
            if (onScreen && canvas != null && Event.current.type == EventType.Repaint)
                Graphics.DrawTexture(new Rect(0, 0, width, height), canvas.Texture, material);
        }

        void OnDisable()
        {
            if (line != null) line.Dispose();
            if (openFont != null) openFont.Dispose();
            foreach (var fallback in openFallbacks) fallback.Dispose();
            if (drawing != null) drawing.Dispose();
            if (canvas != null) canvas.Dispose();
            line = null;
            openFont = null;
            openFallbacks = new Font[0];
            drawing = null;
            canvas = null;
        }
    }
}
