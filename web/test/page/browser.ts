// SPDX-License-Identifier: Apache-2.0
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { type BrowserContext, type Page, chromium } from 'playwright-core';
import type { Report } from '../../src/data';

const TEMPLATE = process.env['STEADYREST_REPORT_TEMPLATE'] ?? fileURLToPath(new URL('../../dist/report.html', import.meta.url));
const CHROMIUM = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((p) => existsSync(p));

export interface OpenPage {
  page: Page;
  context: BrowserContext;
  complaints: string[];
  close: () => Promise<void>;
}

/** The template filled as steadyrest/apps/report fills it. */
export function fill(report: Report): string {
  const json = JSON.stringify(report).replaceAll('<', '\\u003c');
  return readFileSync(TEMPLATE, 'utf8').replace('"@STEADYREST_REPORT_DATA@"', () => json);
}

export function template(): string {
  return readFileSync(TEMPLATE, 'utf8');
}

/** Opens a page from disk in a browser of its own, without any server or network. */
export async function openFromDisk(
  html: string,
  options: { colorScheme?: 'light' | 'dark'; width?: number; height?: number } = {},
): Promise<OpenPage> {
  const folder = mkdtempSync(join(tmpdir(), 'steadyrest-page-'));
  const file = join(folder, 'report.html');
  writeFileSync(file, html);
  const context = await chromium.launchPersistentContext(join(folder, 'profile'), {
    ...(CHROMIUM ? { executablePath: CHROMIUM } : {}),
    headless: true,
    offline: true,
    colorScheme: options.colorScheme ?? 'light',
    viewport: { width: options.width ?? 1280, height: options.height ?? 900 },
    args: [
      '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync',
    ],
  });
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('request', (request) => {
    if (!/^(file|data):/.test(request.url())) complaints.push(`request to ${request.url()}`);
  });
  await page.goto(`file://${file}`);
  return {
    page,
    context,
    complaints,
    close: async () => {
      await context.close();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
