// Writes NAME.png beside each NAME.svg of this folder, as resvg draws it over white. In an empty folder:
//   npm install @resvg/resvg-js@2.6.2
//   cp REPOSITORY/tests/data/svg/conformance/resvg.mjs . && node resvg.mjs REPOSITORY/tests/data
// The fonts are those of tests/data/fetch.sh --only fonts.
import { Resvg } from '@resvg/resvg-js';
import fs from 'fs';
import path from 'path';

const data = process.argv[2];
const folder = path.join(data, 'svg/conformance'), fonts = path.join(data, 'fetched/fonts');
const names = ['DejaVuSans', 'DejaVuSans-Bold', 'DejaVuSerif', 'DejaVuSansMono'];
const fontFiles = [...names.map((name) => `${name}.ttf`), 'NotoSansCJK-Regular.ttc'].map((file) => path.join(fonts, file));
const font = { fontFiles, loadSystemFonts: false, defaultFontFamily: 'DejaVu Serif', serifFamily: 'DejaVu Serif',
  sansSerifFamily: 'DejaVu Sans', monospaceFamily: 'DejaVu Sans Mono' };
for (const file of fs.readdirSync(folder).filter((name) => name.endsWith('.svg'))) {
  const text = fs.readFileSync(path.join(folder, file));
  const drawing = new Resvg(text, { background: 'white', font, fitTo: { mode: 'width', value: 200 } });
  fs.writeFileSync(path.join(folder, file.replace('.svg', '.png')), drawing.render().asPng());
}
