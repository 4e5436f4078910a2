// SPDX-License-Identifier: Apache-2.0
import { fixed } from '../../../frame/numbers';
import { theme as themeNow } from '../../../frame/theme';
import { Strip } from '../../paint/strip';
import type { Context } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import type { Live } from '../../state/live';
import { small, units } from '../../state/units';
import { t } from '../../texts/texts';
import { type Part, readout } from '../part';
import { motionWords } from './path';

const SECONDS = 10;
/** The figure is the largest of so long: one that flickers cannot be read. */
const FIGURE_S = 0.3;

/** The largest |error| of the last seconds; NaN if there is none. */
export function largest(live: Live, seconds: number): number {
  const { samples } = live;
  let most = NaN;
  for (let i = samples.from('t_s', samples.newest('t_s') - seconds); i < samples.size; ++i) {
    const size = Math.abs(samples.at('error_um', i));
    if (!(most >= size) && !Number.isNaN(size)) most = size;
  }
  return most;
}

/** The strip of the contour error against its limit. */
export function errorStrip(context: Context, name: string): Strip {
  const { live } = context;
  const strip: Strip = new Strip(
    live,
    {
      name,
      label: `${t('contour_error')}, ${t('last_seconds', { seconds: SECONDS })}`,
      seconds: SECONDS,
      unit: units().small,
      curves: [{ column: 'error_um', colour: (theme) => theme.run.with }],
      limit: () => live.status?.contour_limit_um ?? live.hello?.contour.limit_um,
    },
    () => strip.draw(themeNow()),
  );
  return strip;
}

export function errorPart(context: Context): Part {
  const { live } = context;
  const strip = errorStrip(context, 'error-strip');
  const now = readout(t('contour_error'), 'error-now', true);
  const limit = readout(t('limit'), 'error-limit');
  const peak = readout(t('peak', { seconds: SECONDS }), 'error-peak');
  const verdict = h('p', { class: 'verdict-line', id: 'error-verdict' });
  const figures = () => {
    const most = live.status?.contour_limit_um ?? NaN;
    const error = largest(live, FIGURE_S);
    setText(now.value, Number.isNaN(error) ? '–' : small(error));
    setText(limit.value, small(most));
    setText(peak.value, small(largest(live, SECONDS)));
    const over = error > most;
    now.root.classList.toggle('over', over);
    setText(verdict, Number.isNaN(error) ? (live.status?.cutting === false ? motionWords(live.status) : t('no_data')) : over ? t('over_limit') : t('of_limit', { percent: fixed((100 * error) / most, 0) }));
    verdict.classList.toggle('over', over);
  };
  return {
    root: panel(t('contour_error'), 'error', h('div', { class: 'readouts' }, h('div', { class: 'lead' }, now.root, verdict), limit.root, peak.root), strip.canvas.element, h('p', { class: 'under' }, `${t('contour_error')}, ${units().small.name} · ${t('last_seconds', { seconds: SECONDS })}`)),
    update: (theme, slow) => {
      strip.draw(theme);
      if (slow) {
        figures();
      }
    },
    redraw: (theme) => strip.draw(theme),
    close: () => strip.canvas.close(),
  };
}
