// SPDX-License-Identifier: Apache-2.0
// The program that the tests run. STEADYREST_PROGRAM names it.
import type { ChildProcess } from 'node:child_process';
import { fileURLToPath } from 'node:url';

export const PROGRAM = process.env['STEADYREST_PROGRAM'] ?? '';
export const ROOT = fileURLToPath(new URL('../../..', import.meta.url));

/** Where the program says that its page is. */
export function started(run: ChildProcess): Promise<[string, string]> {
  return new Promise((resolve, reject) => {
    let said = '';
    run.stderr?.on('data', (part: Buffer) => {
      said += part.toString();
      const found = /Page: (http:\/\/[^/]+)\/#key=(\S+)/.exec(said);
      if (found) {
        resolve([found[1] ?? '', found[2] ?? '']);
      }
    });
    run.on('exit', () => reject(new Error(`the program ended: ${said}`)));
  });
}
