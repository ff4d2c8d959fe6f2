// Pictures of the page, for people and for the docs: `node tests/look.js URL OUT [WIDTHxHEIGHT] [KEYS...]`

import { open } from "./browser.js";

const [url, out, size = "1400x850", ...keys] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const browser = await open();
const page = await browser.newPage({ viewport: { width, height }, colorScheme: "dark" });
page.on("console", (message) => console.log(message.type(), message.text()));
page.on("pageerror", (error) => console.log(String(error)));
await page.goto(url);
await page.waitForTimeout(2500);
for (const key of keys) await page.keyboard.press(key);
await page.waitForTimeout(1500);
await page.screenshot({ path: out, ...(out.endsWith("jpg") ? { type: "jpeg", quality: 82 } : {}) });
await browser.close();
