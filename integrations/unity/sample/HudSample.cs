// A head-up display by gpgp: a crest from an SVG, and texts that change. For an object of any scene; see the README.
using System;
using UnityEngine;

namespace Gpgp.Samples
{
    /// <summary>A crest, a name, a score that counts and a message in a corner of the screen. What has not changed is
    /// neither laid out nor drawn again.</summary>
    [AddComponentMenu("gpgp/HUD sample")]
    public sealed class HudSample : MonoBehaviour
    {
        [Tooltip("An SVG file with the ending .bytes")] public TextAsset crest;
        [Tooltip("A font file with the ending .bytes")] public TextAsset font;
        [Tooltip("Fonts for what it does not have: other scripts, emoji")] public TextAsset[] fallbacks;
        [Tooltip("Blends premultiplied colours: gpgp/Premultiplied")] public Material material;
        public string player = "Ironvale Guard";
        public string message = "The east cylinder runs hot again \U0001F525";
        public int score;

        const int Width = 480, Height = 160, Side = 128, Margin = 16;
        static readonly float[] White = { 1, 1, 1, 1 }, Amber = { 1, 0.48f, 0.07f, 1 }; // linear

        Canvas canvas;
        Drawing drawing;
        Font openFont;
        Font[] openFallbacks = new Font[0];
        Text title, points, words;
        int shownScore;
        string shownMessage;

        void OnEnable()
        {
            if (!Plugin.Ready || font == null)
            {
                Say();
                Debug.LogError(font == null ? "the HUD sample needs a font" : "gpgp is not there: see its README", this);
                enabled = false;
                return;
            }
            canvas = new Canvas(Width, Height);
            if (crest != null) drawing = Drawing.FromSvg(crest.bytes);
            openFont = new Font(font.bytes);
            if (fallbacks != null)
                openFallbacks = Array.ConvertAll(fallbacks, file => new Font(file.bytes));
            openFont.SetFallbacks(openFallbacks);
            title = new Text(openFont, player, 28, White);
            points = new Text(openFont, Points(), 28, Amber);
            words = new Text(openFont, message, 18, White, Width - Side - 3 * Margin);
            Draw();
        }

        void Update()
        {
            Say();
            if (score == shownScore && message == shownMessage) return;
            if (score != shownScore) points.Set(openFont, Points(), 28, Amber);
            if (message != shownMessage) words.Set(openFont, message, 18, White, Width - Side - 3 * Margin);
            Draw();
        }

        /// <summary>Places all in the canvas, and has it drawn with this frame's commands.</summary>
        void Draw()
        {
            shownScore = score;
            shownMessage = message;
            canvas.Background = new Color(0, 0, 0, 0.5f);
            canvas.Clear();
            if (drawing != null)
            {
                var page = drawing.Box;
                var scale = Mathf.Min(Side / page[2], Side / page[3]);
                canvas.Add(drawing, Margin - page[0] * scale, Margin - page[1] * scale, scale);
            }
            const float left = Side + 2 * Margin;
            canvas.Add(title, left, Margin);
            canvas.Add(points, Width - Margin - points.Box[2], Margin);
            canvas.Add(words, left, Margin + title.Box[3] + Margin / 2);
            canvas.Draw();
        }

        void OnGUI()
        {
            if (canvas != null && Event.current.type == EventType.Repaint)
                Graphics.DrawTexture(new Rect(Margin, Margin, Width, Height), canvas.Texture, material);
        }

        void OnDisable()
        {
            foreach (var text in new[] { title, points, words })
                if (text != null) text.Dispose();
            if (openFont != null) openFont.Dispose();
            foreach (var fallback in openFallbacks) fallback.Dispose();
            if (drawing != null) drawing.Dispose();
            if (canvas != null) canvas.Dispose();
            title = points = words = null;
            openFont = null;
            openFallbacks = new Font[0];
            drawing = null;
            canvas = null;
        }

        string Points() { return score.ToString("D7"); }

        void Say()
        {
            foreach (var said in Plugin.TakeMessages()) Debug.LogWarning(said, this);
        }
    }
}
