// SPDX-License-Identifier: Apache-2.0
import type { WayName } from './data';

/** On a plot, in a table, and its colour of the palette. */
export const WAYS: Record<WayName, { label: string; name: string; colour: number }> = {
  alone: { label: 'as programmed', name: 'as programmed', colour: 2 },
  setting: { label: 'setting', name: 'setting of the control', colour: 1 },
  text: { label: 'text', name: 'corrected text', colour: 4 },
  text_held: { label: 'text, held', name: 'corrected text, limit held', colour: 5 },
  text_feeds: { label: 'feeds', name: 'lower feeds in the text', colour: 7 },
  feed_override: { label: 'override', name: 'feed override', colour: 0 },
  path_offsets: { label: 'offsets', name: 'path offsets', colour: 3 },
  changed: { label: 'changed', name: 'alone', colour: 4 },
  changed_feed_override: { label: 'changed + override', name: 'with feed override', colour: 6 },
  changed_path_offsets: { label: 'changed + offsets', name: 'with path offsets', colour: 5 },
};
