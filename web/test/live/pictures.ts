// SPDX-License-Identifier: Apache-2.0
// Pictures compared in the browser, which knows how to read and write them.
import type { Page } from 'playwright-core';

/** A colour channel (0 … 255) may differ by this much: text is smoothed differently on other machines. */
const TOLERANCE = 56;
/** And by this many pixels of the picture it may be elsewhere. */
const REACH = 1;

export interface Compared {
  /** Of the pixels, how many have no equal near their place in the other picture; 1 where the sizes differ. */
  share: number;
  /** PNG: what differs in red, on the actual picture in grey. */
  difference: Buffer;
}

/** `page` is any blank page of the browser. */
export async function compare(page: Page, expected: Buffer, actual: Buffer): Promise<Compared> {
  const { share, difference } = await page.evaluate(
    async ({ pictures, tolerance, reach }) => {
      const [a, b] = await Promise.all(
        pictures.map(async (base64) => {
          const image = new Image();
          image.src = `data:image/png;base64,${base64}`;
          await image.decode();
          const canvas = new OffscreenCanvas(image.width, image.height);
          const pen = canvas.getContext('2d') as OffscreenCanvasRenderingContext2D;
          pen.drawImage(image, 0, 0);
          return pen.getImageData(0, 0, image.width, image.height);
        }),
      );
      if (!a || !b) throw new Error('two pictures are needed');
      const same = (p: ImageData, i: number, q: ImageData, k: number) => [0, 1, 2].every((c) => Math.abs((p.data[i + c] ?? 0) - (q.data[k + c] ?? 0)) <= tolerance);
      const found = (p: ImageData, q: ImageData, x: number, y: number) => {
        for (let v = Math.max(y - reach, 0); v <= Math.min(y + reach, q.height - 1); ++v) {
          for (let u = Math.max(x - reach, 0); u <= Math.min(x + reach, q.width - 1); ++u) {
            if (same(p, 4 * (y * p.width + x), q, 4 * (v * q.width + u))) return true;
          }
        }
        return false;
      };
      const shown = new ImageData(b.width, b.height);
      const sized = a.width === b.width && a.height === b.height;
      let different = 0;
      for (let y = 0; y < b.height; ++y) {
        for (let x = 0; x < b.width; ++x) {
          const i = 4 * (y * b.width + x);
          const differs = sized && !(found(a, b, x, y) && found(b, a, x, y));
          const grey = 160 + 0.12 * ((b.data[i] ?? 0) + (b.data[i + 1] ?? 0) + (b.data[i + 2] ?? 0));
          shown.data.set(differs ? [220, 0, 0, 255] : [grey, grey, grey, 255], i);
          different += differs ? 1 : 0;
        }
      }
      const canvas = new OffscreenCanvas(b.width, b.height);
      (canvas.getContext('2d') as OffscreenCanvasRenderingContext2D).putImageData(shown, 0, 0);
      const bytes = new Uint8Array(await (await canvas.convertToBlob()).arrayBuffer());
      return { share: sized ? different / (b.width * b.height) : 1, difference: btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), '')) };
    },
    { pictures: [expected.toString('base64'), actual.toString('base64')], tolerance: TOLERANCE, reach: REACH },
  );
  return { share, difference: Buffer.from(difference, 'base64') };
}
