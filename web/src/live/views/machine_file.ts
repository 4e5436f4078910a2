// SPDX-License-Identifier: Apache-2.0
import type { Machine } from '../api/types';
import type { Context } from '../shell/context';
import { problem } from '../shell/problem';
import type { Part } from './part';

/** Whether somebody is entering something there, which must stay as it is. */
export function typingIn(place: HTMLElement): boolean {
  const at = document.activeElement;
  return place.contains(at) && at?.matches('input, select, textarea') === true;
}

/** Calls `show` with the machine file, and again whenever another one is in force. `place` shows why it cannot be read. */
export function machineFile(context: Context, place: HTMLElement, show: (machine: Machine) => void): Required<Pick<Part, 'update' | 'close'>> {
  let shown: Machine | undefined;
  let loading = false;
  let closed = false;
  const load = () => {
    loading = true;
    (context.machine ? Promise.resolve(context.machine) : context.loadMachine())
      .then((machine) => {
        if (!closed) {
          shown = machine;
          show(machine);
        }
      })
      .catch((error: unknown) => {
        shown = undefined;
        place.replaceChildren(problem(error, load));
      })
      .finally(() => (loading = false));
  };
  load();
  return {
    update: (_, figures) => {
      if (figures && shown && !loading && context.machine !== shown && !typingIn(place)) {
        load();
      }
    },
    close: () => (closed = true),
  };
}
