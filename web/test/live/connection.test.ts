// SPDX-License-Identifier: Apache-2.0
// Log-in, a stream that drops, and that the page stays small and quick.
import { gzipSync } from 'node:zlib';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, beforeAll, beforeEach, describe, expect, it } from 'vitest';
import { closeBrowser, open } from './browser';
import { accessibilityFaults, beyond, tooSmall, until } from './look';
import { DIST, KEY, Mock } from './mock';

const mock = new Mock();
let address = '';

beforeAll(async () => {
  address = await mock.start();
});
afterAll(async () => {
  await closeBrowser();
  await mock.stop();
});
beforeEach(() => {
  mock.logOut();
  mock.offline = false;
});

describe('the log-in', () => {
  it('is by name and password', async () => {
    const { page, context, complaints } = await open(address, '/#/motion', { loggedIn: false, width: 390 });
    await page.waitForSelector('#by-password');
    expect(await beyond(page)).toEqual([]);
    expect(await tooSmall(page)).toEqual([]);
    expect(await accessibilityFaults(page)).toEqual([]);
    await page.fill('[name=name]', 'olga');
    await page.fill('[name=password]', 'wrong');
    await page.click('#by-password button');
    await until(page, `document.querySelector('.fault').textContent === 'Name or password is wrong. Try again.'`);
    await page.fill('[name=password]', 'right');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#axes');
    expect(complaints.filter((c) => !c.includes('401'))).toEqual([]);
    await context.close();
  });
  it('is by the key in the address, which is removed at once', async () => {
    const { page, context, complaints } = await open(address, `/#key=${KEY}`, { loggedIn: false });
    await page.waitForSelector('#error-strip');
    expect(page.url()).toBe(`${address}/`);
    expect(await page.evaluate('document.cookie')).toBe('');
    expect(complaints).toEqual([]);
    await context.close();
  });
  it('says when the key is wrong, and takes another', async () => {
    const { page, context } = await open(address, '/#key=old', { loggedIn: false });
    await page.waitForSelector('#by-key');
    expect(await page.textContent('.fault')).toBe('This key is wrong.');
    await page.fill('[name=key]', KEY);
    await page.click('#by-key button');
    await page.waitForSelector('#error-strip');
    await context.close();
  });
  it('leaves nothing of the session behind it when a key is wrong', async () => {
    mock.logIn('engineer');
    const { page, context } = await open(address);
    await until(page, `document.querySelector('#connection')?.textContent === 'Live'`);
    await page.evaluate(`location.hash = '#key=old'`);
    await page.waitForSelector('#by-key');
    expect(await page.textContent('.fault')).toBe('This key is wrong.');
    mock.drop();
    await page.waitForTimeout(1500);
    expect(await page.textContent('.toasts')).toBe('');
    await context.close();
  });
  it('is asked for again when the session has ended', async () => {
    mock.logIn('engineer');
    const { page, context } = await open(address);
    await page.waitForSelector('#error-strip');
    mock.logOut();
    await page.click('#hand-back');
    await page.waitForSelector('#by-password');
    await context.close();
  });
});

describe('a stream that drops', () => {
  it('comes back, and the page shows what is missing', async () => {
    mock.logIn('viewer');
    const { page, context } = await open(address);
    await until(page, `document.querySelector('#connection').textContent === 'Live'`);
    await page.waitForTimeout(1000);
    expect(await page.isHidden('#missing')).toBe(true);
    mock.offline = true;
    mock.drop();
    await until(page, `document.querySelector('#connection').textContent.startsWith('Reconnecting since')`);
    expect(await page.textContent('.toasts [role=alert]')).toBe('The connection to the layer is lost.');
    expect(await page.textContent('#say')).toBe('State unknown');
    await page.waitForTimeout(1200);
    mock.offline = false;
    await until(page, `document.querySelector('#connection').textContent === 'Live'`);
    await page.waitForSelector('#missing:not([hidden])');
    expect(await page.textContent('#missing')).toMatch(/^\d+\.\d s missing$/);
    expect(await page.textContent('.toasts [role=alert]')).toMatch(/^Reconnected after [1-9]\d*\.\d s\. The data of that time are missing\.$/);
    await page.click('#missing');
    await until(page, `document.querySelector('.toasts').textContent.includes('did not arrive')`);
    await context.close();
  });
  it('leads to the log-in when the session is gone too', async () => {
    mock.logIn('viewer');
    const { page, context } = await open(address);
    await until(page, `document.querySelector('#connection').textContent === 'Live'`);
    mock.logOut();
    mock.drop();
    await page.waitForSelector('#by-password');
    await context.close();
  });
  it('says after a new log-in how long there was none', async () => {
    mock.logIn('viewer');
    const lastFrame = new Date('2026-01-02T03:04:05Z');
    const { page, context } = await open(address, '/', { before: async (blank) => blank.clock.setFixedTime(lastFrame) });
    await until(page, `document.querySelector('#connection').textContent === 'Live'`);
    mock.logOut();
    mock.drop();
    await page.waitForSelector('#by-password');
    await page.clock.setFixedTime(lastFrame.getTime() + 72_300);
    await page.fill('[name=name]', 'olga');
    await page.fill('[name=password]', 'right');
    await page.keyboard.press('Enter');
    await until(page, `document.querySelector('.toasts [role=alert]').textContent === 'Reconnected after 72.3 s. The data of that time are missing.'`);
    await context.close();
  });
  it('is not spoken of after a log-out by intent', async () => {
    mock.logIn('viewer');
    const { page, context } = await open(address);
    await until(page, `document.querySelector('#connection').textContent === 'Live'`);
    await page.click('#settings');
    await page.click('#log-out');
    await page.waitForSelector('#by-password');
    await page.fill('[name=name]', 'olga');
    await page.fill('[name=password]', 'right');
    await page.keyboard.press('Enter');
    await until(page, `document.querySelector('#connection')?.textContent === 'Live'`);
    await page.waitForTimeout(500);
    expect(await page.textContent('.toasts')).toBe('');
    await context.close();
  });
});

describe('the page', () => {
  it('is under 700 kB compressed', () => {
    const files = readdirSync(DIST, { recursive: true, encoding: 'utf8' }).filter((f) => /\.(js|css|html)$/.test(f));
    const bytes = files.reduce((sum, f) => sum + gzipSync(readFileSync(join(DIST, f))).length, 0);
    console.log(`bundle: ${(bytes / 1000).toFixed(0)} kB gzip`);
    expect(bytes).toBeLessThan(700_000);
  });
  it('has nothing inline, as its content-security policy demands', () => {
    const html = readFileSync(join(DIST, 'index.html'), 'utf8');
    expect(html).not.toMatch(/<style|style=|<script(?![^>]*src=)/);
  });
  it('paints before the layer has answered anything, from three files', async () => {
    mock.logIn('viewer');
    const { page, context } = await open(address, '/', { before: async (blank) => blank.route('**/api/**', () => undefined) });
    await page.waitForFunction(() => performance.getEntriesByName('first-contentful-paint').length > 0);
    const loaded = await page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => new URL(name).pathname).filter((path) => !path.startsWith('/api/')));
    expect(loaded.sort()).toEqual(['/live.css', '/live.js']);
    await context.close();
  });
  it('keeps its memory flat while data stream in, at no more than 30 drawings a second', async () => {
    mock.logIn('viewer');
    const { page, context } = await open(address);
    await page.waitForSelector('#error-strip');
    const seconds = Number(process.env['STEADYREST_STREAM_S'] ?? 20);
    const heap = () => page.evaluate(() => {
      (window as unknown as { gc?: () => void }).gc?.();
      return (performance as unknown as { memory: { usedJSHeapSize: number } }).memory.usedJSHeapSize;
    });
    // The rings are full after 17 s; they are of fixed size from the start.
    await page.waitForTimeout(4000);
    const before = await heap();
    const drawn = await page.evaluate(async () => {
      let count = 0;
      const clear = CanvasRenderingContext2D.prototype.clearRect;
      CanvasRenderingContext2D.prototype.clearRect = function (...a) {
        if (this.canvas.id === 'error-strip') count += 1;
        clear.apply(this, a);
      };
      const began = performance.now();
      await new Promise((done) => setTimeout(done, 3000));
      CanvasRenderingContext2D.prototype.clearRect = clear;
      return (1000 * count) / (performance.now() - began);
    });
    await page.waitForTimeout(1000 * seconds);
    const after = await heap();
    console.log(`heap ${(before / 1e6).toFixed(1)} → ${(after / 1e6).toFixed(1)} MB in ${seconds} s, ${drawn.toFixed(1)} drawings a second`);
    expect(drawn).toBeLessThan(31);
    expect(drawn).toBeGreaterThan(3);
    expect(after - before).toBeLessThan(2_000_000);
    await context.close();
  });
});
