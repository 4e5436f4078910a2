// SPDX-License-Identifier: Apache-2.0
// What is looked for on every view: anything out of the window, faults of accessibility, targets too small for gloves.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import type { Page } from 'playwright-core';
import { expect } from 'vitest';

export const VIEWS = ['now', 'contour', 'chatter', 'thermal', 'motion', 'record', 'record/rib-pocket-2026-01-02.sqlite', 'machine'];

/** Elements that reach beyond the window, by what they are. */
export function beyond(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const scroller = document.scrollingElement as Element;
    const found = scroller.scrollWidth > window.innerWidth ? [`the page is ${scroller.scrollWidth} wide`] : [];
    for (const e of document.querySelectorAll('#app *, dialog *')) {
      const box = e.getBoundingClientRect();
      const hidden = e.closest('.skip, details:not([open]) > :not(summary)') !== null;
      if (!hidden && box.width > 0 && (box.right > window.innerWidth + 0.5 || box.left < -0.5)) {
        found.push(`${e.tagName} ${e.id} ${e.className} ${Math.round(box.left)}…${Math.round(box.right)}: ${(e.textContent ?? '').slice(0, 40)}`);
      }
    }
    return found.slice(0, 5);
  });
}

const GLOVE_PX = 48;

/** Controls that are smaller than a gloved finger needs. */
export function tooSmall(page: Page): Promise<string[]> {
  return page.evaluate(
    (least) =>
      [...document.querySelectorAll<HTMLElement>('#app button, #app a:not(.skip), #app select, #app input, #app summary, dialog button, dialog select')]
        .filter((e) => e.offsetParent !== null && e.id !== 'missing')
        .map((e) => ({ e, box: e.getBoundingClientRect() }))
        .filter(({ e, box }) => box.height < least - 0.5 || (box.width < least - 0.5 && !e.classList.contains('sort')))
        .map(({ e, box }) => `${e.tagName} ${e.id} ${e.textContent?.slice(0, 20)} ${Math.round(box.width)} × ${Math.round(box.height)}`),
    GLOVE_PX,
  );
}

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

interface Axe {
  run: (options: object) => Promise<{ violations: { id: string; impact: string; nodes: { target: string[]; failureSummary: string }[] }[] }>;
}

/** Serious and critical findings of axe-core. */
export async function accessibilityFaults(page: Page): Promise<string[]> {
  // Through the debugger, which the page's content-security policy does not bind.
  await page.evaluate(AXE);
  return page.evaluate(async () => {
    const { violations } = await (window as unknown as { axe: Axe }).axe.run({ resultTypes: ['violations'] });
    return violations.filter((v) => v.impact === 'serious' || v.impact === 'critical').flatMap((v) => v.nodes.slice(0, 3).map((n) => `${v.id}: ${n.target.join(' ')} (${n.failureSummary.split('\n').slice(1, 2).join('').trim()})`));
  });
}

/** Distinct colours of each live plot, to tell a drawing from an empty area. */
export function colours(page: Page): Promise<Record<string, number>> {
  return page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll<HTMLCanvasElement>('canvas')].map((canvas, i) => {
        const pixels = canvas.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
        const seen = new Set<number>();
        for (let k = 0; k + 3 < pixels.length; k += 4) {
          if ((pixels[k + 3] ?? 0) > 200) seen.add(((pixels[k] ?? 0) << 16) | ((pixels[k + 1] ?? 0) << 8) | (pixels[k + 2] ?? 0));
        }
        return [canvas.id || `chart-${i}`, seen.size];
      }),
    ),
  );
}

/** Goes to a view and waits until it has drawn what it has. */
export async function show(page: Page, view: string): Promise<void> {
  await page.evaluate((to) => (window.location.hash = `#/${to}`), view);
  await page.waitForFunction(() => document.querySelector('#view .panel') !== null);
  await page.waitForTimeout(500);
}

const PATIENCE_MS = 10_000;

/** Waits until an expression in the page is true. Asked from outside: the page's content-security policy forbids it to evaluate text. */
export async function until(page: Page, expression: string): Promise<void> {
  await expect.poll(() => page.evaluate(expression), { timeout: PATIENCE_MS, interval: 50, message: expression }).toBe(true);
}
