// SPDX-License-Identifier: Apache-2.0
// The strongest line in words: where it is among the spindle's orders and the process's modes, and how sure that is.
import { fixed, percent } from '../../../frame/numbers';
import type { ChatterNow } from '../../api/types';
import { type TextKey, t } from '../../texts/texts';

/** Above or below something. */
const beside = (off_hz: number, above: TextKey, below: TextKey) => (off_hz < 0 ? below : above);
const off = (hz: number) => fixed(Math.abs(hz), 1);

function placeWords({ line, kind, chatter }: ChatterNow): string {
  if (!line) {
    return '';
  }
  const hz = fixed(line.frequency_hz, 0);
  if (chatter && kind === 'flip') {
    return t('line_flip', { hz });
  }
  if (line.nearest_order === null) {
    return t('line_alone', { hz });
  }
  const order = line.order_folded ? t('order_folded', { order: line.nearest_order }) : line.nearest_order;
  return line.forced ? t('line_forced', { hz, order }) : t(beside(line.from_order_hz, 'line_above', 'line_below'), { hz, order, off: off(line.from_order_hz), sd: fixed(line.from_order_sd_hz, 1) });
}

/** Empty while no line stands out. */
export function lineWords(now: ChatterNow): string {
  const { confidence, nearest_mode: mode } = now;
  const words = [
    placeWords(now),
    confidence == null ? '' : t('confidence', { percent: percent(confidence, 0) }),
    mode ? t(beside(mode.off_hz, 'mode_above', 'mode_below'), { off: off(mode.off_hz), hz: fixed(mode.frequency_hz, 0) }) : '',
  ];
  return words.filter((part) => part !== '').join(' · ');
}

/** What the signal says of the spindle and of the sensor. */
export function signalWords({ spindle_rpm: rpm, spindle_sd_rpm: sd, clips }: ChatterNow): string {
  const words = [rpm == null ? '' : t('spindle_found', { rpm: fixed(rpm, 1), sd: fixed(sd ?? 0, 1) }), clips ? t('clips') : ''];
  return words.filter((part) => part !== '').join(' · ');
}
