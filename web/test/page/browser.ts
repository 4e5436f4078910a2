// SPDX-License-Identifier: Apache-2.0
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { type Browser, type Page, chromium } from 'playwright-core';

const TEMPLATE = process.env['STEADYREST_PAGE'] ?? fileURLToPath(new URL('../../dist/page.html', import.meta.url));
const CHROMIUM = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((p) => existsSync(p));

const WRITTEN = process.env['STEADYREST_WRITTEN_PAGES'] ?? '';

/** Has the program written its pages? */
export const haveWritten = WRITTEN !== '' && existsSync(WRITTEN);

export function writtenHtml(name: string): string {
  return readFileSync(join(WRITTEN, name, 'report.html'), 'utf8');
}

/** A page as the program wrote it, and its JSON. */
export function written<Data>(name: string): { html: string; data: Data } {
  return { html: writtenHtml(name), data: JSON.parse(readFileSync(join(WRITTEN, name, 'report.json'), 'utf8')) as Data };
}

export interface OpenPage {
  page: Page;
  complaints: string[];
  close: () => Promise<void>;
}

/** The template filled as steadyrest/apps/page/shared fills it. */
export function fill(report: object): string {
  const json = JSON.stringify(report).replaceAll('<', '\\u003c');
  return template().replace('"@STEADYREST_REPORT_DATA@"', () => json);
}

export function template(): string {
  return readFileSync(TEMPLATE, 'utf8');
}

let browser: Browser | undefined;

async function launched(): Promise<Browser> {
  browser ??= await chromium.launch({
    ...(CHROMIUM ? { executablePath: CHROMIUM } : {}),
    headless: true,
    args: [
      '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync',
    ],
  });
  return browser;
}

export async function closeBrowser(): Promise<void> {
  await browser?.close();
  browser = undefined;
}

/** Opens a page from disk in a window of its own, without any server or network. */
export async function openFromDisk(html: string, options: { colorScheme?: 'light' | 'dark'; width?: number; height?: number } = {}): Promise<OpenPage> {
  const folder = mkdtempSync(join(tmpdir(), 'steadyrest-page-'));
  const file = join(folder, 'report.html');
  writeFileSync(file, html);
  const context = await (await launched()).newContext({
    offline: true,
    colorScheme: options.colorScheme ?? 'light',
    viewport: { width: options.width ?? 1280, height: options.height ?? 900 },
  });
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`request to ${request.url()}`);
  });
  await page.goto(`file://${file}`);
  return {
    page,
    complaints,
    close: async () => {
      await context.close();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}

/** Share of a plot's pixels that are near to this colour. */
export function share(open: OpenPage, id: string, colour: string): Promise<number> {
  return open.page.evaluate(
    ([where, wanted]) => {
      const canvas = document.querySelector<HTMLCanvasElement>(`#${where} canvas`);
      const pixels = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
      const rgb = [1, 3, 5].map((i) => Number.parseInt((wanted as string).slice(i, i + 2), 16));
      let found = 0;
      for (let i = 0; i + 2 < pixels.length; i += 4) {
        found += rgb.every((c, k) => Math.abs(c - (pixels[i + k] ?? 0)) < 6) ? 1 : 0;
      }
      return (4 * found) / Math.max(pixels.length, 1);
    },
    [id, colour],
  );
}

/** Distinct colours of each plot, to tell a drawing from an empty area. */
export function colours(open: OpenPage): Promise<Record<string, number>> {
  return open.page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll<HTMLElement>('.plot')].map((plot) => {
        const canvas = plot.querySelector('canvas');
        const pixels = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
        const seen = new Set<number>();
        for (let i = 0; i + 2 < pixels.length; i += 4) {
          seen.add(((pixels[i] ?? 0) << 16) | ((pixels[i + 1] ?? 0) << 8) | (pixels[i + 2] ?? 0));
        }
        return [plot.id, seen.size];
      }),
    ),
  );
}
