// usage: report_pictures.mjs RESULTS FOLDER: writes screenshots of the report in RESULTS: FOLDER/report.png (the top,
// with the player at the end of the motion) and FOLDER/report-page.png (the whole page).
import { resolve } from "node:path";
import { chromium } from "playwright-core";

const [results, folder] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1200, height: 860 } });
await page.goto(`file://${resolve(results)}/report.html`);
await page.$eval("input[type=range]", (slider) => {
  slider.value = slider.max;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
});
await page.screenshot({ path: `${folder}/report.png` });
await page.screenshot({ path: `${folder}/report-page.png`, fullPage: true });
await browser.close();
