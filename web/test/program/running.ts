// SPDX-License-Identifier: Apache-2.0
// The program on the simulated machine, with its page. STEADYREST_PROGRAM names it.
import { type ChildProcess, execFileSync, spawn } from 'node:child_process';
import { appendFileSync, copyFileSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const PROGRAM = process.env['STEADYREST_PROGRAM'] ?? '';
export const ROOT = fileURLToPath(new URL('../../..', import.meta.url));

/** Modulates in every cut; Z has a thermal model that forecasts nothing by itself, so that handing back waits for no cut to end. */
export const ROOMS = `
[chatter]
enabled = true
m_code_on = 0
m_code_off = 0
[thermal]
enabled = true
[[thermal.axis]]
name = "Z"
[[thermal.axis.mode]]
tau_min = 15
speeds_rpm = [0, 6000]
levels_um = [0, 0]
`;

/** What the program prints. */
export const steadyrest = (of: readonly string[], input = ''): string => execFileSync(PROGRAM, of, { encoding: 'utf8', input });

/** Address and key of the page of a run that has just begun; the key is empty where people have accounts. */
function pageOf(run: ChildProcess): Promise<[string, string]> {
  return new Promise((resolve, reject) => {
    let said = '';
    let known = false;
    run.stderr?.on('data', (part: Buffer) => {
      said += part.toString();
      if (known) return;
      const found = /Page: (http:\/\/[^/\s]+)\/(?: \(its address with the key: (.+)\))?\n/.exec(said);
      if (found) {
        known = true;
        const whole = found[2] === undefined ? '' : readFileSync(found[2], 'utf8');
        resolve([found[1] ?? '', /#key=(\S+)/.exec(whole)?.[1] ?? '']);
      }
    });
    run.on('exit', () => reject(new Error(`the program ended: ${said}`)));
  });
}

/** `make demo` without its build. */
export class Demo {
  address = '';
  key = '';
  private said = '';
  private run: ChildProcess | undefined;

  async start(): Promise<void> {
    // In a separate process group, so that Ctrl-C ends all of it, as in a terminal.
    const run = spawn('sh', ['scripts/demo.sh'], { cwd: ROOT, detached: true, env: { ...process.env, LAYER: PROGRAM, LISTEN: '0' } });
    this.run = run;
    run.stdout.on('data', (part: Buffer) => (this.said += part.toString()));
    [this.address, this.key] = await pageOf(run);
  }

  /** What it has said. */
  async end(): Promise<string> {
    const { run } = this;
    if (run?.pid && run.exitCode === null) {
      const ended = new Promise((done) => run.once('close', done));
      process.kill(-run.pid, 'SIGINT');
      await ended;
    }
    return this.said;
  }
}

export class Running {
  readonly folder = mkdtempSync(join(tmpdir(), 'steadyrest-page-'));
  readonly machine = join(this.folder, 'machine.toml');
  address = '';
  /** Empty where people have accounts. */
  key = '';
  private run: ChildProcess | undefined;

  /** The example's machine, with more at the end of its file, cuts the example's pocket again and again. */
  async start(more = '', work: readonly string[] = ['--program', 'examples/programs/rib-pocket.mpf', '--record', join(this.folder, 'runs')]): Promise<void> {
    copyFileSync(join(ROOT, 'examples/machines/vmc-840d.toml'), this.machine);
    appendFileSync(this.machine, more);
    const run = spawn(PROGRAM, ['run', '--machine', this.machine, ...work, '--repeat', '--socket', join(this.folder, 's'), '--listen', '0'], { cwd: ROOT });
    this.run = run;
    [this.address, this.key] = await pageOf(run);
  }

  /** As Ctrl-C does; waits until it has ended. */
  async end(): Promise<void> {
    const { run } = this;
    if (run && run.exitCode === null) {
      const ended = new Promise((done) => run.once('exit', done));
      run.kill('SIGTERM');
      await ended;
    }
  }

  stop(): void {
    this.run?.kill('SIGTERM');
    rmSync(this.folder, { recursive: true, force: true });
  }
}
