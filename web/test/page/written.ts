// SPDX-License-Identifier: Apache-2.0
import { afterAll, beforeAll } from 'vitest';
import { type OpenPage, openFromDisk, written } from './browser';

/** Opens pages that the program wrote, for the tests of this block: by name, each with its data. */
export function openWritten<Page>(folders: Readonly<Record<string, string>>): <T extends Page>(name: string) => { open: OpenPage; page: T } {
  const opened = new Map<string, { open: OpenPage; page: Page }>();
  beforeAll(async () => {
    for (const [name, folder] of Object.entries(folders)) {
      const { html, data } = written<Page>(folder);
      opened.set(name, { open: await openFromDisk(html), page: data });
    }
  });
  afterAll(async () => {
    for (const { open } of opened.values()) {
      await open.close();
    }
  });
  return <T extends Page>(name: string) => opened.get(name) as { open: OpenPage; page: T };
}
