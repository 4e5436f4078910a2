// SPDX-License-Identifier: Apache-2.0
// Two people at one machine: what one changes, the other sees.
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from '../live/browser';
import { ROOMS, Running, steadyrest } from './running';

const FRAMES_A_SECOND = 30;
const SOON_S = 1.5;
const PASSWORD = 'a long password';

const running = new Running();
let anna: Open;
let vera: Open;

async function logIn(name: string): Promise<Open> {
  const opened = await open(running.address, '/', { loggedIn: false, before: countFrames });
  await opened.page.fill('[name=name]', name);
  await opened.page.fill('[name=password]', PASSWORD);
  await opened.page.keyboard.press('Enter');
  await opened.page.waitForSelector('#mode-badge[data-mode]');
  return opened;
}

const go = (page: Page, view: string) => page.evaluate((to) => (window.location.hash = `#/${to}`), view);

/** Counts the frames that the layer sends. */
const countFrames = (page: Page) =>
  page.addInitScript(() => {
    const counted = Object.assign(window, { frames_seen: 0 });
    const Native = WebSocket;
    window.WebSocket = class extends Native {
      constructor(url: string | URL) {
        super(url);
        this.addEventListener('message', (event) => (counted.frames_seen += (JSON.parse(String(event.data)) as { type: string }).type === 'frame' ? 1 : 0));
      }
    };
  });
/** Within so many seconds by the layer's own frames, however busy the computer is. */
async function within(seconds: number, page: Page, expression: string): Promise<void> {
  const frames = await page.evaluate(`new Promise((done) => {
    const from = frames_seen;
    const look = () => ((${expression}) || frames_seen - from > ${FRAMES_A_SECOND * seconds} ? done(frames_seen - from) : setTimeout(look, 10));
    look();
  })`);
  expect(frames, expression).toBeLessThanOrEqual(FRAMES_A_SECOND * seconds);
}
const soon = (page: Page, expression: string) => within(SOON_S, page, expression);

beforeAll(async () => {
  const users = join(running.folder, 'users.json');
  steadyrest(['page', 'add-user', 'anna', '--role', 'engineer', '--users', users], `${PASSWORD}\n`);
  steadyrest(['page', 'add-user', 'vera', '--role', 'viewer', '--users', users], `${PASSWORD}\n`);
  await running.start(ROOMS, ['--program', 'examples/programs/rib-pocket.mpf', '--users', users]);
  [anna, vera] = [await logIn('anna'), await logIn('vera')];
});
afterAll(async () => {
  running.stop();
  await closeBrowser();
});

it('shows the mode that the other one asks for', async () => {
  await anna.page.click('[data-mode=act]:not(.badge)');
  await anna.page.click('dialog .strong');
  await soon(vera.page, `document.querySelector('#mode-badge').textContent === 'Act'`);
  expect(await vera.page.textContent('.toasts')).toContain('The mode is now Act.');
});

it('shows a change of the machine file', async () => {
  await go(anna.page, 'contour');
  await go(vera.page, 'contour');
  await vera.page.waitForSelector('[data-key="contour.limit_um"] input');
  await anna.page.fill('[data-key="contour.limit_um"] input', '12.5');
  await anna.page.click('#review');
  await anna.page.click('#apply');
  await anna.page.waitForSelector('dialog', { state: 'detached' });
  for (const { page } of [anna, vera]) {
    await soon(page, `document.querySelector('[data-key="contour.limit_um"] input').value === '12.5'`);
  }
});

it('shows the modulation that the other one sets', async () => {
  await go(anna.page, 'chatter');
  await go(vera.page, 'chatter');
  await vera.page.waitForSelector('#law');
  await anna.page.selectOption('#law', 'sine');
  await anna.page.click('#set-modulation');
  await anna.page.click('dialog .strong');
  await soon(vera.page, `document.querySelector('#law').value === 'sine'`);
});

it('lets the one hand back what the other let act', async () => {
  await vera.page.click('#hand-back');
  await soon(anna.page, `document.querySelector('#mode-badge').textContent === 'Observe'`);
});

it('shows a measured size', async () => {
  await go(anna.page, 'thermal');
  await go(vera.page, 'thermal');
  await vera.page.waitForSelector('.thermal-row');
  await anna.page.fill('#measured-value', '0.6');
  await anna.page.click('#measured button');
  await soon(anna.page, `/re-zeroed/.test(document.querySelector('#readings').textContent)`);
  // The others ask for the history every 10 s.
  await within(12, vera.page, `/re-zeroed/.test(document.querySelector('#readings').textContent)`);
  expect([anna.complaints, vera.complaints].map((all) => all.filter((c) => !c.includes('401')))).toEqual([[], []]);
});
