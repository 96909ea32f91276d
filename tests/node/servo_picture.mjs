// usage: servo_picture.mjs RESULTS FILE: writes a picture of the last servo in the report of RESULTS.
import { resolve } from "node:path";
import { chromium } from "playwright-core";

const [results, file] = process.argv.slice(2);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1200, height: 860 } });
await page.goto(`file://${resolve(results)}/report.html`);
await page.locator("section", { has: page.getByRole("heading", { name: /^Servo:/ }) }).last().screenshot({ path: file });
await browser.close();
