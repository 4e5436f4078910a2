// SPDX-License-Identifier: Apache-2.0
// A plot of the reports in a view of the live page. The charts are loaded with the first that is shown.
import { type Theme, theme } from '../../frame/theme';
import type { Plot } from '../../plot/drawn';
import { drawnIn } from '../../plot/drawn';
import type { ToolWords } from '../../plot/tools';
import { h } from '../shell/h';
import { t } from '../texts/texts';

const words = (): ToolWords => ({ tools: t('plot_tools'), zoomIn: t('zoom_in'), zoomOut: t('zoom_out'), fit: t('fit'), showWhole: t('show_whole'), savePicture: t('save_picture'), saveValues: t('save_values') });

export class Plotted {
  readonly root: HTMLElement;
  private make: ((theme: Theme) => Plot) | undefined;

  constructor(
    private readonly id: string,
    private readonly kind = '',
  ) {
    this.root = h('div', { class: 'plotted' });
  }

  /** Draws this from now on. */
  async set(make: (theme: Theme) => Plot): Promise<void> {
    const first = this.make === undefined;
    this.make = make;
    if (first) {
      const { host } = await import('../../plot/plot');
      this.root.innerHTML = host(this.id, this.kind, words());
    }
    await this.redraw(theme());
  }

  async redraw(now: Theme): Promise<void> {
    const { plot } = await import('../../plot/plot');
    if (this.make && this.root.isConnected && this.root.firstChild) {
      plot(this.id, this.make(now), now);
    }
  }

  close(): void {
    const where = this.root.querySelector<HTMLElement>('.plot');
    if (where) {
      drawnIn(where)?.chart.dispose();
    }
  }
}
