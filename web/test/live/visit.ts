// SPDX-License-Identifier: Apache-2.0
// A browser on the mock, logged in as somebody.
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, expect } from 'vitest';
import type { Role } from '../../src/live/api/types';
import { type Open, closeBrowser, open } from './browser';
import { until } from './look';
import { type Asked, Mock } from './mock';

export class Visit {
  readonly mock = new Mock();
  private address = '';
  private opened: Open | undefined;

  /** Starts the mock before all tests, and closes each test's page after it, which must have nothing to complain about. */
  constructor() {
    beforeAll(async () => {
      this.address = await this.mock.start();
    });
    afterAll(async () => {
      await closeBrowser();
      await this.mock.stop();
    });
    beforeEach(() => {
      this.mock.asked.length = 0;
      this.mock.layer.wanted = 'observe';
      this.mock.limit_um = 10;
    });
    afterEach(async () => {
      const complaints = this.opened?.complaints ?? [];
      await this.opened?.context.close();
      expect(complaints.filter((c) => !/status of 4\d\d/.test(c))).toEqual([]);
    });
  }

  get page(): Page {
    if (!this.opened) throw new Error('nobody has opened the page');
    return this.opened.page;
  }

  readonly as = async (role: Role, view = 'now', width = 1440): Promise<void> => {
    this.mock.logIn(role);
    this.opened = await open(this.address, `/#/${view}`, { width });
    await this.page.waitForFunction(() => document.querySelector('#mode-badge')?.textContent !== '–');
  };
  /** What the page complained of so far was meant. */
  readonly excuse = (): void => {
    if (this.opened) this.opened.complaints.length = 0;
  };
  readonly last = (): Asked | undefined => this.mock.asked.at(-1);
  readonly until = (expression: string): Promise<void> => until(this.page, expression);
  readonly text = (selector: string): Promise<string | null> => this.page.textContent(selector);
}
