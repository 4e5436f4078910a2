// SPDX-License-Identifier: Apache-2.0
// What holds of every page: as the program wrote them, in a real browser, opened from disk.
import { readFile } from 'node:fs/promises';
import type { Download } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it, vi } from 'vitest';
import { type OpenPage, closeBrowser, colours, haveWritten, openFromDisk, writtenHtml } from './browser';

const WIDTHS = [1440, 1024, 390];

interface Shown {
  chart: { getOption(): { dataZoom: { start: number; end: number }[]; xAxis: { name: string }[] }; getWidth(): number };
  plot: { group?: string; plane?: boolean; x: { name: string }; layers: { name?: string; kind: string }[] };
}
type WithPlots = { steadyrestPlot: (id: string) => Shown };

const plotIds = (open: OpenPage) => open.page.locator('.plot').evaluateAll((all) => all.map((e) => e.id));
const zoomOf = (open: OpenPage, id: string) => open.page.evaluate((i) => (window as unknown as WithPlots).steadyrestPlot(i).chart.getOption().dataZoom.map((z) => [Math.round(z.start), Math.round(z.end)]), id);

/** Elements that reach beyond the window, by what they are. */
const beyond = (open: OpenPage) =>
  open.page.evaluate(() => {
    const scroller = document.scrollingElement as Element;
    const found = scroller.scrollWidth > window.innerWidth ? [`the page is ${scroller.scrollWidth} wide`] : [];
    for (const e of document.querySelectorAll('main *')) {
      const box = e.getBoundingClientRect();
      if (box.width > 0 && (box.right > window.innerWidth + 0.5 || box.left < -0.5)) {
        found.push(`${e.tagName} ${e.id} ${e.className} ${Math.round(box.left)}…${Math.round(box.right)}: ${(e.textContent ?? '').slice(0, 40)}`);
      }
    }
    return found.slice(0, 5);
  });

/** A busy computer takes long to lay a page out and to make a picture. */
const PATIENCE_MS = 60_000;

/** A4 between its margins. */
const A4_PX = 688;

/** What is not shown whole of plots as vectors: pictures higher than their place, labels that reach out of them, rasters out of shape. */
const cut = (open: OpenPage) =>
  open.page.evaluate(async () => {
    const found: string[] = [];
    for (const plot of document.querySelectorAll<HTMLElement>('.plot')) {
      const svg = plot.querySelector('svg');
      const place = plot.getBoundingClientRect();
      if (!svg || svg.clientHeight > place.height + 1 || svg.clientWidth > place.width + 1) {
        found.push(`${plot.id}: ${svg?.clientWidth} × ${svg?.clientHeight} in ${place.width} × ${place.height}`);
      }
      for (const text of plot.querySelectorAll('svg text')) {
        const box = text.getBoundingClientRect();
        if (box.width > 0 && (box.left < place.left - 1 || box.right > place.right + 1 || box.top < place.top - 1 || box.bottom > place.bottom + 1)) {
          found.push(`${plot.id}: label ${text.textContent}`);
        }
      }
      for (const image of plot.querySelectorAll('svg image')) {
        const source = new Image();
        source.src = image.getAttribute('href') ?? image.getAttribute('xlink:href') ?? '';
        await source.decode();
        const drawn = Number(image.getAttribute('width')) / Number(image.getAttribute('height'));
        if (Math.abs(source.naturalWidth / source.naturalHeight / drawn - 1) > 0.01) {
          found.push(`${plot.id}: raster ${source.naturalWidth} × ${source.naturalHeight} drawn ${drawn}`);
        }
      }
    }
    return found;
  });

/** What the buttons PNG and CSV of these plots save, by the name of the file. */
async function saved(open: OpenPage, ids: readonly string[]): Promise<Map<string, Buffer>> {
  const downloads = new Map<string, Download>();
  const keep = (d: Download) => downloads.set(d.suggestedFilename(), d);
  open.page.on('download', keep);
  let wanted = 0;
  for (const [id, tool] of ids.flatMap((i) => [[i, 'png'], [i, 'csv']])) {
    ++wanted;
    // Chromium drops what a page saves beyond ten files within a second, and a busy one more; who saves by hand presses
    // again. A file that comes late has the same name, so it counts once.
    for (let presses = 0; presses < 3 && downloads.size < wanted; ++presses) {
      await open.page.click(`#${id}-frame [data-tool="${tool}"]`);
      const timeout = presses === 0 ? 1500 : PATIENCE_MS / 3;
      await vi.waitUntil(() => downloads.size === wanted, { timeout, interval: 10 }).catch(() => undefined);
    }
    expect(downloads.size, `${id}.${tool}`).toBe(wanted);
  }
  open.page.off('download', keep);
  return new Map(await Promise.all([...downloads].map(async ([name, d]): Promise<[string, Buffer]> => [name, await readFile(await d.path())])));
}

/** Rows of a CSV without quoted line ends. */
function rowsOf(csv: string): string[][] {
  return csv.trimEnd().split('\n').map((line) => [...`${line},`.matchAll(/("(?:[^"]|"")*"|[^,]*),/g)].map((m) => m[1] ?? ''));
}

/** `pages`: where each is, and how many plots it has. */
export function testEach(pages: Record<string, number>): void {
  afterAll(closeBrowser);

  describe.runIf(haveWritten).each(Object.entries(pages))('the page %s', (name, count) => {
    let open: OpenPage;
    beforeAll(async () => {
      open = await openFromDisk(writtenHtml(name), { width: 390 });
    });
    afterAll(() => open.close());

    it('draws every plot, explains itself and says how it was made', async () => {
      const seen = Object.entries(await colours(open));
      expect(seen.length).toBe(count);
      seen.forEach(([id, number]) => expect(number, id).toBeGreaterThan(15));
      expect(await open.page.locator('.explanation dt').count()).toBeGreaterThan(2);
      expect(await open.page.textContent('#made-command')).toMatch(/^steadyrest \w+/);
      expect(await open.page.textContent('#made-date')).toMatch(/^20\d\d-\d\d-\d\dT/);
      if (!['bench', 'sample'].includes(name)) { // one reads no file, the other is no verb's
        const hashes = await open.page.locator('#inputs td').allTextContents();
        expect(hashes.length).toBeGreaterThan(0);
        hashes.forEach((h) => expect(h).toMatch(/^[\da-f]{64}$/));
      }
      expect(open.complaints).toEqual([]);
    });

    it('has nothing that runs over on a telephone, a tablet and a screen', async () => {
      await expect.poll(() => beyond(open), { message: 'opened at 390', timeout: PATIENCE_MS }).toEqual([]);
      for (const width of WIDTHS) {
        await open.page.setViewportSize({ width, height: 900 });
        await open.page.waitForFunction((w) => (document.querySelector('.plot canvas')?.clientWidth ?? 1e9) <= w, width);
        // Plots take their new width one after another.
        await expect.poll(() => beyond(open), { message: `at ${width}`, timeout: PATIENCE_MS }).toEqual([]);
      }
    });

    it('zooms each plot, those of a group together, and goes back', async () => {
      const steps = await open.page.evaluate(() => {
        const shown = (id: string) => (window as unknown as WithPlots).steadyrestPlot(id);
        const all = [...document.querySelectorAll('.plot')].map((e) => e.id);
        const zoomed = (id: string) => shown(id).chart.getOption().dataZoom.map((z) => [Math.round(z.start), Math.round(z.end)]);
        return all.map((id) => {
          const { group, plane } = shown(id).plot;
          const others = group === undefined ? [id] : all.filter((k) => shown(k).plot.group === group);
          const use = (tool: string) => {
            document.querySelector<HTMLElement>(`#${id}-frame [data-tool="${tool}"]`)?.click();
            return { own: zoomed(id), group: others.map((k) => zoomed(k)[0]) };
          };
          return { id, plane: plane === true, near: use('in'), back: [use('in'), use('out')][1], whole: use('whole') };
        });
      });
      expect(steps.length).toBe(count);
      for (const { id, plane, near, back, whole } of steps) {
        const half = [[25, 75], plane ? [25, 75] : [0, 100]];
        expect(near.own, id).toEqual(half);
        near.group.forEach((x) => expect(x, id).toEqual([25, 75]));
        expect(back?.own, id).toEqual(half);
        expect(whole.own, id).toEqual([[0, 100], [0, 100]]);
        whole.group.forEach((x) => expect(x, id).toEqual([0, 100]));
      }
      expect(open.complaints).toEqual([]);
    });

    it('zooms by the wheel with a key and scrolls without', async () => {
      const id = (await plotIds(open))[0] ?? '';
      const plane = await open.page.evaluate((i) => (window as unknown as WithPlots).steadyrestPlot(i).plot.plane === true, id);
      const zoomed = async () => (await zoomOf(open, id)).map(([from = 0, to = 0]) => to - from < 100);
      const wheel = async (key: string, by: number) => {
        await open.page.keyboard.down(key);
        await open.page.mouse.wheel(0, by);
        await open.page.keyboard.up(key);
      };
      await open.page.locator(`#${id}`).scrollIntoViewIfNeeded();
      await open.page.locator(`#${id}`).hover();
      const from = await open.page.evaluate(() => window.scrollY);
      await open.page.mouse.wheel(0, 60);
      await open.page.waitForFunction((y) => window.scrollY > y, from);
      expect(await zoomed()).toEqual([false, false]);
      await wheel('Control', -120);
      await expect.poll(zoomed).toEqual([true, plane]);
      await wheel('Shift', -120);
      await expect.poll(zoomed).toEqual([true, true]);
      await open.page.click(`#${id}-frame [data-tool="whole"]`);
      expect(await zoomOf(open, id)).toEqual([[0, 100], [0, 100]]);
      expect(open.complaints).toEqual([]);
    });

    it('saves each plot as a picture and as values', async () => {
      const ids = await plotIds(open);
      const files = await saved(open, ids);
      expect(files.size).toBe(2 * ids.length);
      for (const id of ids) {
        const of = (kind: string) => [...files].find(([name]) => name.endsWith(`-${id}.${kind}`))?.[1] ?? Buffer.alloc(0);
        const png = of('png');
        expect(png.subarray(1, 4).toString(), id).toBe('PNG');
        const width = await open.page.evaluate((i) => (window as unknown as WithPlots).steadyrestPlot(i).chart.getWidth(), id);
        expect(png.readUInt32BE(16), id).toBe(2 * width);
        const [head = [], ...rows] = rowsOf(of('csv').toString());
        expect(head.length, id).toBeGreaterThan(1);
        expect(rows.length, id).toBeGreaterThan(0);
        expect(rows.every((r) => r.length === head.length && r.every((v) => v === '' || Number.isFinite(Number(v)))), id).toBe(true);
        expect(rows.flat().filter((v) => v !== '').length, id).toBeGreaterThan(rows.length);
      }
      expect(open.complaints).toEqual([]);
    });

    it('prints every plot as vectors, whole and in shape, and draws on the screen again afterwards', async () => {
      const event = (type: string) => open.page.evaluate((t) => window.dispatchEvent(new Event(t)), type);
      await open.page.setViewportSize({ width: A4_PX, height: 900 });
      await open.page.emulateMedia({ media: 'print' });
      await event('beforeprint');
      expect(await cut(open)).toEqual([]);
      expect(await beyond(open)).toEqual([]);
      const drawn = await open.page.locator('.plot').evaluateAll((all) => all.map((e) => ({ id: e.id, svg: e.querySelectorAll('svg path, svg image, svg polygon').length, canvas: e.querySelectorAll('canvas').length })));
      drawn.forEach((d) => expect(d.svg, d.id).toBeGreaterThan(4));
      expect(drawn.every((d) => d.canvas === 0)).toBe(true);
      await event('afterprint');
      await open.page.emulateMedia({ media: null });
      Object.entries(await colours(open)).forEach(([id, number]) => expect(number, id).toBeGreaterThan(15));
      expect((await open.page.pdf({ format: 'A4', preferCSSPageSize: true })).length).toBeGreaterThan(10_000);
      expect(open.complaints).toEqual([]);
    });
  });
}
