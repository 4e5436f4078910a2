// SPDX-License-Identifier: Apache-2.0
// Every view at every size and in every look: nothing overflows, nothing is too small, nothing is hard to reach.
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { ALL, type TextKey } from '../../src/live/texts/texts';
import { closeBrowser, open } from './browser';
import { VIEWS, accessibilityFaults, beyond, colours, show, tooSmall } from './look';
import { Mock } from './mock';

const mock = new Mock();
let address = '';

beforeAll(async () => {
  address = await mock.start();
  mock.logIn('engineer');
  mock.layer.wanted = 'act';
});
afterAll(async () => {
  await closeBrowser();
  await mock.stop();
});

describe.each([[390, 844], [1024, 768], [1440, 900]])('at %i × %i', (width, height) => {
  it('every view fits, has targets for gloves, and draws', async () => {
    const { page, context, complaints } = await open(address, '/', { width, height });
    for (const view of VIEWS) {
      await show(page, view);
      expect(await beyond(page), view).toEqual([]);
      expect(await tooSmall(page), view).toEqual([]);
      for (const [id, count] of Object.entries(await colours(page))) {
        expect(count, `${view} ${id}`).toBeGreaterThan(3);
      }
    }
    expect(complaints).toEqual([]);
    await context.close();
  });
});

describe.each(['light', 'dark', 'contrast'])('in the look %s', (look) => {
  it('axe-core finds nothing serious on any view', async () => {
    const { page, context } = await open(address, '/', { width: 1024, height: 768, settings: { language: 'en', look, units: 'mm' } });
    for (const view of VIEWS) {
      await show(page, view);
      expect(await accessibilityFaults(page), view).toEqual([]);
    }
    await page.click('#settings');
    expect(await accessibilityFaults(page), 'settings').toEqual([]);
    await context.close();
  });
});

describe.each(['de', 'zh', 'ru'] as const)('in %s', (language) => {
  it.each([390, 1024])('at %i px every view fits', async (width) => {
    const { page, context, complaints } = await open(address, '/', { width, height: 768, settings: { language, look: 'light', units: 'inch' } });
    for (const view of VIEWS) {
      await show(page, view);
      expect(await beyond(page), view).toEqual([]);
      const title = (view.split('/')[0] ?? '') as TextKey;
      expect(await page.title()).toBe(`${ALL[language][title]} – Steadyrest`);
    }
    expect(complaints).toEqual([]);
    await context.close();
  });
});
