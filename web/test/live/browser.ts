// SPDX-License-Identifier: Apache-2.0
import { existsSync } from 'node:fs';
import { type Browser, type BrowserContext, type Page, chromium } from 'playwright-core';

const CHROMIUM = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((p) => existsSync(p));

let browser: Browser | undefined;

async function launched(): Promise<Browser> {
  browser ??= await chromium.launch({
    ...(CHROMIUM ? { executablePath: CHROMIUM } : {}),
    headless: true,
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--enable-precise-memory-info', '--js-flags=--expose-gc'],
  });
  return browser;
}

export async function closeBrowser(): Promise<void> {
  await browser?.close();
  browser = undefined;
}

export interface Open {
  page: Page;
  context: BrowserContext;
  complaints: string[];
}

export interface Options {
  width?: number;
  height?: number;
  /** A session's cookie, so that no log-in is needed. */
  loggedIn?: boolean;
  settings?: object;
  /** Pixels of the screen for one of the page. */
  scale?: number;
  /** Done with the page while it is still empty. */
  before?: (page: Page) => Promise<void>;
}

export async function open(address: string, path = '/', { width = 1440, height = 900, loggedIn = true, settings = { language: 'en', look: 'light', units: 'mm' }, scale = 1, before }: Options = {}): Promise<Open> {
  const context = await (await launched()).newContext({ viewport: { width, height }, deviceScaleFactor: scale, locale: 'en-GB', timezoneId: 'UTC', acceptDownloads: true });
  if (loggedIn) {
    await context.addCookies([{ name: 'steadyrest_session', value: 'mock', url: address, httpOnly: true, sameSite: 'Strict' }]);
  }
  await context.addInitScript(`localStorage.getItem('steadyrest-settings') ?? localStorage.setItem('steadyrest-settings', ${JSON.stringify(JSON.stringify(settings))})`);
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(error.message));
  await before?.(page);
  await page.goto(address + path);
  return { page, context, complaints };
}
