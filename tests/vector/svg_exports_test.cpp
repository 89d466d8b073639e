// Small drawings of the shape that tools write: what is drawn is what plain features draw, and all else is named.
#include "svg_import.h"

#include <gtest/gtest.h>

namespace {
using namespace gpgp;
using namespace gpgp::test;

using Texts = std::vector<std::string>;

struct Export {
  const char* tool;
  const char* text;
  const char* reference; ///< what is drawn of it
  Texts messages;
};

const Export kExports[] = {
    {"Inkscape",
     R"svg(<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="100mm" height="100mm" viewBox="0 0 100 100" version="1.1" inkscape:version="1.2">
<sodipodi:namedview pagecolor="#ff0000" inkscape:pageopacity="1"><inkscape:grid type="xygrid"/></sodipodi:namedview>
<defs><linearGradient id="a"><stop style="stop-color:#ff0000;stop-opacity:1" offset="0"/><stop style="stop-color:#0000ff;stop-opacity:1;" offset="1"/></linearGradient>
<linearGradient inkscape:collect="always" xlink:href="#a" id="b" x1="20" y1="0" x2="80" y2="0" gradientUnits="userSpaceOnUse" gradientTransform="translate(0,0)"/>
<marker id="m" style="overflow:visible"><path style="fill:context-stroke" d="M0 0h9v9"/></marker></defs>
<g inkscape:groupmode="layer" style="display:inline;opacity:1"><path style="color:#000000;font-variation-settings:'wght' 400;display:inline;overflow:visible;visibility:visible;opacity:1;vector-effect:none;fill:url(#b);fill-opacity:1;fill-rule:evenodd;stroke:none;stroke-width:0.26458332px;stroke-linecap:butt;stroke-linejoin:miter;stroke-miterlimit:4;stroke-dasharray:none;stroke-dashoffset:0;stroke-opacity:1;marker:none;marker-start:none;paint-order:markers fill stroke;enable-background:accumulate;color-rendering:auto;image-rendering:auto;shape-rendering:auto;solid-color:#000000;mix-blend-mode:normal;isolation:auto;filter-blend-mode:normal;-inkscape-stroke:none;color-interpolation:sRGB;color-interpolation-filters:linearRGB;clip-rule:nonzero;stop-color:#000;shape-padding:0;white-space:pre;inline-size:0;text-orientation:mixed" d="M 20,20 H 80 V 80 H 20 Z" sodipodi:nodetypes="ccccc"/></g></svg>)svg",
     "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='20' x2='80'><stop stop-color='red'/><stop offset='1' "
     "stop-color='blue'/></linearGradient><rect x='20' y='20' width='60' height='60' fill='url(#g)'/>",
     {}},
    {"Illustrator",
     R"svg(<?xml version="1.0" encoding="utf-8"?>
<!-- Generator: Adobe Illustrator 16.0.0, SVG Export Plug-In -->
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd" [
  <!ENTITY ns_svg "http://www.w3.org/2000/svg"><!ENTITY ns_xlink "http://www.w3.org/1999/xlink">
  <!ENTITY ns_ai "http://ns.adobe.com/AdobeIllustrator/10.0/">]>
<svg version="1.1" xmlns="&ns_svg;" xmlns:xlink="&ns_xlink;" xmlns:i="&ns_ai;" width="100px" height="100px" viewBox="0 0 100 100" enable-background="new 0 0 100 100" xml:space="preserve">
<style type="text/css"><![CDATA[.st0{fill:#00AA00;}
  .st1{clip-path:url(#SVGID_2_);}]]></style>
<switch><foreignObject requiredExtensions="&ns_ai;" x="0" y="0" width="1" height="1"><i:pgfRef xlink:href="#p"/></foreignObject>
<g i:extraneous="self"><defs><rect id="SVGID_1_" x="20" y="20" width="60" height="60"/></defs><clipPath id="SVGID_2_"><use xlink:href="#SVGID_1_" overflow="visible"/></clipPath>
<g class="st1"><rect class="st0" width="100" height="100"/></g></g></switch></svg>)svg",
     "<rect x='20' y='20' width='60' height='60' fill='#0a0'/>",
     {}},
    {"Figma",
     R"svg(<svg width="100" height="100" viewBox="0 0 100 100" fill="none" xmlns="http://www.w3.org/2000/svg">
<g clip-path="url(#clip0_1_2)"><rect x="20" y="20" width="90" height="60" fill="black" fill-opacity="0.5"/>
<g filter="url(#filter0_d)"><path d="M0 0H10V10H0Z" fill="#FF0000"/></g>
<g style="mix-blend-mode:multiply"><path d="M90 0H100V10H90Z" fill="#FF0000"/></g></g>
<defs><filter id="filter0_d" color-interpolation-filters="sRGB"><feFlood flood-opacity="0" result="BackgroundImageFix"/><feBlend mode="normal" in="SourceGraphic" in2="BackgroundImageFix" result="shape"/></filter><clipPath id="clip0_1_2"><rect width="100" height="100" fill="white"/></clipPath></defs></svg>)svg",
     "<path d='M20 20H100V80H20Z' fill-opacity='.5'/><path d='M0 0H10V10H0ZM90 0H100V10H90Z' fill='red'/>",
     {}},
    {"matplotlib",
     R"svg(<?xml version="1.0" encoding="utf-8" standalone="no"?>
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">
<svg xmlns:xlink="http://www.w3.org/1999/xlink" width="75pt" height="75pt" viewBox="0 0 75 75" xmlns="http://www.w3.org/2000/svg" version="1.1">
<metadata><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"/></metadata>
<defs><style type="text/css">*{stroke-linejoin: round; stroke-linecap: butt}</style></defs>
<g id="figure_1"><g id="patch_1"><path d="M 0 75 L 75 75 L 75 0 L 0 0 z" style="fill: #ffffff"/></g>
<defs><path id="m1" d="M 0 0 L 0 15" style="stroke: #0000ff; stroke-width: 15"/></defs>
<g><use xlink:href="#m1" x="37.5" y="30" style="stroke: #0000ff; stroke-width: 15"/></g>
<g clip-path="url(#p1)"><path d="M 0 60 L 75 60" style="fill: none; stroke: #00aa00; stroke-width: 15; stroke-linecap: square"/></g></g>
<g transform="translate(0 15) scale(0.15 -0.15)"><defs><path id="DejaVuSans-30" d="M 0 0 L 0 6400 L 6400 6400 z" transform="scale(0.015625)"/></defs><use xlink:href="#DejaVuSans-30"/></g>
<defs><clipPath id="p1"><rect x="15" y="0" width="45" height="75"/></clipPath></defs></svg>)svg",
     "<rect x='40' y='40' width='20' height='20' fill='#00f'/><rect x='20' y='70' width='60' height='20' fill='#0a0'/>"
     "<path d='M0 20V0H20Z'/>",
     {}},
    {"draw.io",
     R"svg(<svg xmlns="http://www.w3.org/2000/svg" style="background: #ffffaa; background-color: light-dark(#ffffaa, #121212); color-scheme: light dark;" xmlns:xlink="http://www.w3.org/1999/xlink" version="1.1" width="100px" height="100px" viewBox="0 0 100 100" content="&lt;mxfile&gt;"><defs/><g><g data-cell-id="0">
<rect x="20" y="20" width="60" height="60" fill="#00aa00" stroke="none" pointer-events="all" style="fill: light-dark(rgb(0, 170, 0), rgb(18, 18, 18));"/>
<g transform="translate(-0.5 -0.5)"><switch>
<foreignObject style="overflow: visible; text-align: left;" pointer-events="none" width="100%" height="100%" requiredFeatures="http://www.w3.org/TR/SVG11/feature#Extensibility"><div xmlns="http://www.w3.org/1999/xhtml">a</div></foreignObject>
<text x="60" y="34">a</text></switch></g></g></g><switch><g requiredFeatures="http://www.w3.org/TR/SVG11/feature#Extensibility"/><a transform="translate(0,-5)" xlink:href="https://x" target="_blank"><text>Text is not SVG - cannot display</text></a></switch></svg>)svg",
     "<rect width='100' height='100' fill='#ffa'/><rect x='20' y='20' width='60' height='60' fill='#0a0'/>",
     {"test.svg:4:1: warning: <foreignObject> is not supported: <switch> shows what follows it",
      "test.svg:5:1: warning: <text> is not supported"}},
    {"d3",
     R"svg(<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100" viewBox="0,0,100,100" style="max-width: 100%; height: auto; font: 10px sans-serif;">
<g fill="steelblue"><rect x="20" y="20" height="60" width="60"></rect></g><g transform="translate(0,90)" fill="none" font-size="10" font-family="sans-serif" text-anchor="middle"><path class="domain" stroke="currentColor" stroke-width="10" d="M0,0H100"></path>
<g class="tick" opacity="1" transform="translate(50,0)"><line stroke="currentColor" y2="6" y1="-10"></line></g></g></svg>)svg",
     "<rect x='20' y='20' width='60' height='60' fill='steelblue'/><path d='M0 85H100V95H0ZM49.5 80H50.5V96H49.5Z'/>",
     {}},
    {"PlantUML",
     R"svg(<?xml version="1.0" encoding="us-ascii" standalone="no"?><?plantuml 1.2023?>
<svg xmlns="http://www.w3.org/2000/svg" contentStyleType="text/css" height="100px" preserveAspectRatio="none" style="width:100px;height:100px;background:#FFFFFF;" version="1.1" viewBox="0 0 100 100" width="100px" zoomAndPan="magnify"><defs/><g>
<rect fill="#00AA00" height="60" rx="0" ry="0" style="stroke:none;stroke-width:0.5;" width="60" x="20" y="20"/></g></svg>)svg",
     "<rect width='100' height='100' fill='#fff'/><rect x='20' y='20' width='60' height='60' fill='#0a0'/>",
     {}},
    {"an icon for dark pages",
     R"svg(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><style>path { fill: #00aa00 }
@media (prefers-color-scheme: dark) { path { fill: #fff } }</style><path d="M20 20h60v60h-60z"/></svg>)svg",
     "<rect x='20' y='20' width='60' height='60' fill='#0a0'/>",
     {}},
    {"cairo",
     R"svg(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="100" height="100" viewBox="0 0 100 100">
<defs><g><g id="glyph-0-0"><path d="M 0 0 L 60 0 L 60 60 L 0 60 Z M 0 0 "/></g></g><clipPath id="clip-0"><path clip-rule="nonzero" d="M 0 0 L 100 0 L 100 80 L 0 80 Z"/></clipPath></defs>
<g clip-path="url(#clip-0)"><g fill="rgb(0%, 66.66667%, 0%)" fill-opacity="1"><use xlink:href="#glyph-0-0" x="20" y="20"/></g></g>
<path fill="none" stroke-width="10" stroke-linecap="butt" stroke-linejoin="miter" stroke="rgb(0%, 0%, 100%)" stroke-opacity="1" stroke-miterlimit="10" d="M 0 95 L 100 95 "/></svg>)svg",
     "<rect x='20' y='20' width='60' height='60' fill='#0a0'/><rect y='90' width='100' height='10' fill='#00f'/>",
     {}},
    {"Mermaid",
     R"svg(<svg id="m" width="100%" xmlns="http://www.w3.org/2000/svg" style="max-width: 100px; background-color: white;" viewBox="0 0 100 100" role="graphics-document document">
<style>#m{font-family:arial;font-size:16px;fill:#333;}#m .node rect{fill:#0a0;stroke:none;}#m :root{--mermaid-font-family:arial;}</style>
<g class="node"><rect x="20" y="20" width="60" height="60"></rect></g></svg>)svg",
     "<rect width='100' height='100' fill='white'/><rect x='20' y='20' width='60' height='60' fill='#0a0'/>",
     {}},
};

TEST(SvgExports, AreDrawnAndWhatIsNotIsNamed) {
  for (const Export& e : kExports) {
    SCOPED_TRACE(e.tool);
    const Import given = import(e.text), right = page(e.reference);
    EXPECT_EQ(given.error, "");
    EXPECT_EQ(given.placed, e.messages);
    EXPECT_EQ(right.placed, Texts());
    EXPECT_LE(worst(picture(given), picture(right)), 1.01); // a colour is rounded to 8 bits in some
  }
}

} // namespace
