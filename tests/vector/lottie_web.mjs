// Draws the animations of tests/data/lottie with lottie-web in Chromium, for LottiePictures.LookAsLottieWebDrawsThem:
//   npm install lottie-web@5.12.2 puppeteer-core@22 @sparticuz/chromium@123      in an empty folder, with this file
//   node lottie_web.mjs REPOSITORY/tests/data/lottie OUT
//   GPGP_LOTTIE_WEB=OUT vector_lottie_pictures_test
import chromium from '@sparticuz/chromium';
import fs from 'fs';
import path from 'path';
import puppeteer from 'puppeteer-core';

const [source, out] = process.argv.slice(2);
const player = fs.readFileSync('node_modules/lottie-web/build/player/lottie_svg.min.js', 'utf8');
const browser = await puppeteer.launch({
  executablePath: await chromium.executablePath(),
  args: [...chromium.args, '--no-sandbox', '--disable-gpu'],
  headless: true,
  defaultViewport: { width: 100, height: 100 },
});
fs.mkdirSync(out, { recursive: true });
for (const file of fs.readdirSync(source).filter((name) => name.endsWith('.json'))) {
  const page = await browser.newPage();
  await page.setContent('<body style="margin:0"><div id="a" style="width:100px;height:100px"></div></body>');
  await page.addScriptTag({ content: player });
  await page.evaluate((animationData) => {
    const container = document.getElementById('a');
    window.animation = lottie.loadAnimation({ container, renderer: 'svg', loop: false, autoplay: false, animationData });
  }, JSON.parse(fs.readFileSync(path.join(source, file))));
  for (const frame of [0, 12, 30, 45, 58]) {
    await page.evaluate((f) => window.animation.goToAndStop(f, true), frame);
    fs.writeFileSync(path.join(out, `${path.parse(file).name}_${frame}.png`), await page.screenshot({ omitBackground: true }));
  }
  await page.close();
}
await browser.close();
