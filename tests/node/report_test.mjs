// Opens a run's report.html in Chromium and tests it through its user interface.
//   node report_test.mjs REPORT.html [--screenshots DIR]
// Exit status 0: success; 1: failure. Prints "skipped:" on stdout if playwright-core or the browser is not installed (a
// failure if FLEXURA_REQUIRE_NODE is set).
import assert from "node:assert/strict";
import { existsSync, mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { parseArgs } from "node:util";

const { positionals, values: options } = parseArgs({
  allowPositionals: true,
  options: { screenshots: { type: "string" } },
});
const report = pathToFileURL(resolve(positionals[0])).href;
const browserPath = process.env.FLEXURA_CHROMIUM ?? "/usr/bin/chromium";

const playwright = await import("playwright-core").catch(() => null);
if (playwright === null || !existsSync(browserPath)) {
  const isRequired = process.env.FLEXURA_REQUIRE_NODE !== undefined;
  console.log(`${isRequired ? "failed" : "skipped"}: needs \`npm ci\` in tests/node and ${browserPath}`);
  process.exit(isRequired ? 1 : 0);
}

const browser = await playwright.chromium.launch({
  executablePath: browserPath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking"],
});

/** A page with the report, and the list of everything that went wrong in it. */
async function open(settings = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, ...settings });
  const page = await context.newPage();
  const faults = [];
  // The browser's own remarks on WebGL without a graphics card are no faults of the page.
  page.on("console", (message) => { if (message.type() !== "log" && !/WebGL/.test(message.text())) faults.push(message.text()); });
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("request", (request) => { if (![report, "data:,"].includes(request.url())) faults.push(request.url()); });
  await page.addInitScript(() => {
    window.violations = [];
    document.addEventListener("securitypolicyviolation", (event) => window.violations.push(event.violatedDirective));
  });
  await page.goto(report);
  return { page, faults };
}

const text = (page, selector) => page.locator(selector).textContent();
const timeOf = async (page) => Number((await text(page, "#time")).match(/-?\d+\.\d+/)[0]);
const armOf = (page) => page.locator("#stage .view .tube").evaluateAll((tubes) => tubes.map((tube) => tube.getAttribute("d")));
const circlesIn = (page, selector) => page.locator(selector).evaluateAll((circles) =>
  circles.map((circle) => [Number(circle.getAttribute("cx")), Number(circle.getAttribute("cy"))]));
const summary = (page, name) => text(page, `.summary div:has(dt:text-matches("^${name}\\\\b")) dd`);

async function scrubTo(page, time) {
  await page.locator("#scrub").evaluate((slider, value) => {
    slider.value = value;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }, time);
}

const limits = (page) => page.locator("#scrub").evaluate((slider) => [Number(slider.min), Number(slider.max)]);

function near(found, wanted, tolerance, what) {
  assert.equal(found.length, wanted.length, what);
  found.flat().forEach((value, i) => assert.ok(Math.abs(value - wanted.flat()[i]) <= tolerance, `${what}: ${found} against ${wanted}`));
}

const checks = {
  async "scrubbing shows the arm that the summary and the pictures tell of"() {
    const { page, faults } = await open();
    const [first, last] = await limits(page);
    for (const [name, time] of [["start", first], ["end", last]]) {
      await scrubTo(page, time);
      assert.equal(await text(page, "#tip"), await summary(page, name));
      // The page's script and the program draw the same arm independently of each other.
      for (const mark of ["tip", "joint"]) {
        near(await circlesIn(page, `#stage .view .${mark}`), await circlesIn(page, `#picture-arm-${name} .${mark}`), 0.02, `${mark} at the ${name}`);
      }
    }
    assert.deepEqual(faults, []);
    assert.deepEqual(await page.evaluate(() => window.violations), []);
  },

  async "playing moves the arm and pausing stops it"() {
    const { page } = await open();
    const before = await armOf(page);
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForFunction(() => parseFloat(document.getElementById("time").textContent.slice(4)) > 0.1);
    await page.getByRole("button", { name: "Pause" }).click();
    const stopped = await armOf(page);
    assert.notDeepEqual(stopped, before);
    await page.waitForTimeout(200);
    assert.deepEqual(await armOf(page), stopped);
  },

  async "playing without loop ends at the end and starts over"() {
    const { page } = await open();
    const [, last] = await limits(page);
    await page.getByLabel("loop").uncheck();
    await page.getByLabel("speed").selectOption("50");
    await page.getByRole("button", { name: "Play" }).click();
    await page.waitForFunction((end) => Number(document.getElementById("scrub").value) === end, last);
    await page.getByLabel("speed").selectOption("0.1");
    await page.getByRole("button", { name: "Play" }).click();
    assert.ok((await timeOf(page)) < last / 2);
  },

  async "the keyboard plays, steps and jumps"() {
    const { page } = await open();
    const [first, last] = await limits(page);
    const step = (last - first) / 100;
    await page.locator("#stage").focus();
    for (const [key, time] of [["ArrowRight", first + step], ["Shift+ArrowRight", first + 11 * step],
      ["ArrowLeft", first + 10 * step], ["End", last], ["Home", first]]) {
      await page.keyboard.press(key);
      assert.ok(Math.abs((await timeOf(page)) - time) < 1e-3, `${key}: ${await timeOf(page)} instead of ${time}`);
    }
    await page.keyboard.press("Space");
    assert.equal(await text(page, "#play"), "Pause");
    await page.keyboard.press("Space");
    assert.equal(await text(page, "#play"), "Play");
    await page.locator("#scrub").focus();
    await page.keyboard.press("End");
    assert.ok(Math.abs((await timeOf(page)) - last) < 1e-3);
    assert.match(await page.locator("#scrub").getAttribute("aria-valuetext"), /^t = /);
    await page.locator("#stage").focus();
    await page.keyboard.press("Tab");
    assert.equal(await page.evaluate(() => document.activeElement.id), "scrub");
    assert.notEqual(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle), "none");
  },

  async "a chart shows its values at the player's time, and at the pointer's"() {
    const { page, faults } = await open();
    const chart = page.locator(".chart").first();
    const values = async () => (await chart.locator(".u-value").allTextContents()).map(Number);
    const [first, last] = await limits(page);
    await scrubTo(page, last);
    const atEnd = await values();
    assert.ok(Math.abs(atEnd[0] - last) < 1e-3 * (1 + last), `${atEnd[0]} is not ${last}`);
    // The table beside the player must show the same numbers.
    const cells = (await page.locator("#values tbody tr td:nth-child(2)").allTextContents()).map(Number);
    near([atEnd.slice(1)], [cells], 0.05, "chart against table");
    const plot = chart.locator(".u-over");
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    assert.notDeepEqual(await values(), atEnd);
    await page.mouse.move(0, 0);
    assert.deepEqual(await values(), atEnd);
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    assert.ok(Math.abs((await timeOf(page)) - (first + last) / 2) < 0.02 * (last - first), "a click takes the player there");
    assert.deepEqual(faults, []);
  },

  async "every chart is drawn, in each line's own colour"() {
    const { page } = await open();
    for (const chart of await page.locator(".chart").all()) {
      assert.equal(await chart.locator("canvas").count(), 1);
      const looks = await chart.locator(".u-series:not(:first-child) .u-marker").evaluateAll((markers) =>
        markers.map((marker) => getComputedStyle(marker).borderTopColor));
      const drawn = await chart.locator("canvas").evaluate((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const colors = new Set();
        for (let i = 0; i < data.length; i += 4) if (data[i + 3] === 255) colors.add(`rgb(${data[i]}, ${data[i + 1]}, ${data[i + 2]})`);
        return [...colors];
      });
      assert.ok(looks.some((look) => drawn.includes(look)), `${looks} in none of its pixels`);
    }
  },

  async "nothing is wider than the window, clipped or on top of something else"() {
    for (const width of [1280, 768, 390, 320]) {
      const { page } = await open({ viewport: { width, height: 720 } });
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `overflows at ${width}`);
      const faults = await page.evaluate(() => {
        const found = [];
        for (const svg of document.querySelectorAll("svg.figure")) {
          const sheet = svg.getBoundingClientRect();
          const texts = [...svg.querySelectorAll("text")].filter((element) => element.textContent !== "");
          const boxes = texts.map((element) => element.getBoundingClientRect());
          boxes.forEach((box, i) => {
            const name = `${svg.ariaLabel}: ${texts[i].textContent}`;
            if (box.left < sheet.left - 0.5 || box.right > sheet.right + 0.5 || box.top < sheet.top - 0.5 || box.bottom > sheet.bottom + 0.5) found.push(`clipped: ${name}`);
            for (let k = 0; k < i; ++k) {
              const other = boxes[k];
              if (box.left < other.right - 1 && other.left < box.right - 1 && box.top < other.bottom - 2 && other.top < box.bottom - 2) found.push(`${name} is on top of ${texts[k].textContent}`);
            }
          });
        }
        return found;
      });
      assert.deepEqual(faults, [], `at ${width}`);
    }
  },

  async "the page follows the wish for a dark page and for less motion"() {
    const { page } = await open({ colorScheme: "dark", reducedMotion: "reduce" });
    const [r] = (await page.evaluate(() => getComputedStyle(document.body).backgroundColor)).match(/\d+/g);
    assert.ok(Number(r) < 60);
    assert.equal(await page.getByLabel("loop").isChecked(), false);
    const { page: plain } = await open();
    assert.equal(await plain.getByLabel("loop").isChecked(), true);
  },

  async "every id is there once"() {
    const { page } = await open();
    const ids = await page.locator("[id]").evaluateAll((elements) => elements.map((element) => element.id));
    assert.deepEqual([...new Set(ids)], ids);
  },

  async "without scripts the pictures are there and the player is not"() {
    const { page } = await open({ javaScriptEnabled: false });
    assert.equal(await page.locator("#player").isVisible(), false);
    assert.equal(await page.locator("#picture-arm-end svg").isVisible(), true);
  },
};

/** report.png, report-dark.png, report-phone.png (whole pages) and player.png, a little past the middle of the motion. */
async function takeScreenshots(folder) {
  mkdirSync(folder, { recursive: true });
  for (const [name, settings] of Object.entries({
    "report": {},
    "report-dark": { colorScheme: "dark" },
    "report-phone": { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2 },
  })) {
    const { page } = await open(settings);
    const [first, last] = await limits(page);
    await scrubTo(page, first + 0.64 * (last - first));
    await page.screenshot({ path: join(folder, `${name}.png`), fullPage: true });
    if (name === "report") await page.locator(".player").screenshot({ path: join(folder, "player.png") });
  }
}

let failed = 0;
for (const [name, check] of Object.entries(checks)) {
  try {
    await check();
    console.log(`ok: ${name}`);
  } catch (error) {
    failed += 1;
    console.error(`FAILED: ${name}\n${error.stack}`);
  }
}
if (options.screenshots !== undefined) await takeScreenshots(options.screenshots);
await browser.close();
process.exit(failed === 0 ? 0 : 1);
