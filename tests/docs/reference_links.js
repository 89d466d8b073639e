// Checks the HTML of the reference: every link and picture of every page leads to something that is there, the public
// functions and the guide's pages are among them, and the search index has entries.
//
//   node reference_links.js HTML_DIR SOURCE_DIR
'use strict';
const fs = require('fs');
const path = require('path');
const [, , dir, source] = process.argv;
const pages = fs.readdirSync(dir).filter(name => name.endsWith('.html'));
const anchors = {}, links = {};
const decode = text => text.replace(/&amp;/g, '&').replace(/&#39;/g, "'");
for (const page of pages) {
  const text = fs.readFileSync(path.join(dir, page), 'utf8');
  anchors[page] = new Set([...text.matchAll(/\s(?:id|name)="([^"]+)"/g)].map(match => decode(match[1])));
  links[page] = [...text.matchAll(/\s(?:href|src)="([^"]*)"/g)].map(match => decode(match[1]));
}
let wrong = 0, checked = 0;
const fail = message => { console.error('FAILED: ' + message); ++wrong; };
for (const page of pages)
  for (const link of links[page]) {
    if (/^(https?:|mailto:|javascript:|#$|data:)/.test(link) || link === '') continue;
    ++checked;
    const [file, anchor] = link.split('#');
    const target = file === '' ? page : decodeURIComponent(file);
    if (!fs.existsSync(path.join(dir, target))) fail(`${page}: ${link} is not there`);
    else if (anchor && anchors[target] && !anchors[target].has(decodeURIComponent(anchor))) fail(`${page}: ${target} has no #${anchor}`);
  }
// Nothing of the API and of the guide is left out.
const all = pages.map(page => fs.readFileSync(path.join(dir, page), 'utf8')).join('\n');
let functions = 0, structs = 0;
for (const header of fs.readdirSync(path.join(source, 'include/gpgp')).filter(name => name.endsWith('.h'))) {
  const text = fs.readFileSync(path.join(source, 'include/gpgp', header), 'utf8');
  for (const match of text.matchAll(/GPGP_API [^;(]*\b(gpgp\w+)\(/g)) {
    ++functions;
    if (!new RegExp(`<td class="memname">[^<]*(<a[^>]*>[^<]*</a>[^<]*)*\\b${match[1]}\\b`).test(all)) fail(`${match[1]} has no entry`);
  }
  for (const match of text.matchAll(/^typedef struct (Gpgp\w+) \{/gm)) {
    ++structs;
    if (!fs.existsSync(path.join(dir, `struct${match[1].replace(/([A-Z])/g, c => '_' + c.toLowerCase())}.html`)) &&
        !fs.existsSync(path.join(dir, `struct${match[1]}.html`))) fail(`${match[1]} has no page`);
  }
}
let guide = 0;
for (const page of fs.readdirSync(path.join(source, 'docs/guide')).filter(name => name.endsWith('.md'))) {
  ++guide;
  const name = 'guide_' + page.slice(0, -3);
  if (!pages.includes(name + '.html')) fail(`docs/guide/${page} is no page`);
}
let shown = 0;
for (const page of fs.readdirSync(path.join(source, 'docs/guide')).filter(name => name.endsWith('.md'))) {
  const text = fs.readFileSync(path.join(source, 'docs/guide', page), 'utf8');
  const html = `guide_${page.slice(0, -3)}.html`;
  for (const match of text.matchAll(/(?:!\[[^\]]*\]\(|<img src=")\.\.\/(pictures\/[^)"]+)/g)) {
    ++shown;
    if (!(links[html] || []).includes(match[1])) fail(`${html} does not show ${match[1]}`);
  }
}
if (shown < 20) fail('the guide\'s pictures were not read');
const index = path.join(dir, 'search', 'all_0.js');
if (!fs.existsSync(index)) fail('there is no search index');
if (functions < 100 || structs < 80 || guide < 20) fail('the headers or the guide were not read');
console.log(`${pages.length} pages, ${checked} links, ${shown} pictures, ${functions} functions, ${structs} structs, ${guide} pages of the guide`);
process.exit(wrong ? 1 : 0);
