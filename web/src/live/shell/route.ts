// SPDX-License-Identifier: Apache-2.0

export const VIEW_NAMES = ['now', 'contour', 'chatter', 'thermal', 'motion', 'record', 'machine'] as const;
export type ViewName = (typeof VIEW_NAMES)[number];

export interface Route {
  view: ViewName;
  /** What follows the view's name: of a record, its name. */
  argument: string;
}

/** `#/record/NAME`; anything else is the first view. */
export function routeOf(hash: string): Route {
  const [name = '', ...rest] = hash.replace(/^#\/?/, '').split('/');
  const view = VIEW_NAMES.find((v) => v === name) ?? 'now';
  let argument = rest.join('/');
  try {
    argument = decodeURIComponent(argument);
  } catch {
    // A % that encodes nothing: as written.
  }
  return { view, argument };
}

export function addressOf(view: ViewName, argument = ''): string {
  return argument === '' ? `#/${view}` : `#/${view}/${encodeURIComponent(argument)}`;
}

/** The key that the program's address brings. */
export function keyOf(hash: string): string | undefined {
  const key = new URLSearchParams(hash.slice(1)).get('key');
  return key === null || key === '' ? undefined : key;
}
