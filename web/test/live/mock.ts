// SPDX-License-Identifier: Apache-2.0
// A server like that of `run --listen`, so that the page can be tested alone: the built page with its
// content-security policy, sessions with roles, the stream, and answers to everything.
import { existsSync, readFileSync } from 'node:fs';
import { type IncomingMessage, type Server, type ServerResponse, createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import type { Duplex } from 'node:stream';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Modulation, Role } from '../../src/live/api/types';
import { RECORDS, checked, encoders, lobes, machine, plan, record, recordData, thermal } from './answers';
import { Layer } from './layer';
import { type Socket, accept } from './websocket';

export const DIST = process.env['STEADYREST_LIVE_PAGE'] ?? fileURLToPath(new URL('../../dist-live', import.meta.url));
const CSP =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const TYPES: Record<string, string> = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css' };
const CSRF = 'csrf-of-the-mock';
export const KEY = 'one-time-key';
const FRAME_MS = 1000 / 30;

const ACCOUNTS: Record<string, Role> = { vera: 'viewer', olga: 'operator', anna: 'engineer' };
/** Taken in act only with `confirm`. */
const MOVES = ['modulation', 'thermal/measured', 'machine/apply'];
const RANK: Record<Role, number> = { viewer: 0, operator: 1, engineer: 2 };

interface Body {
  [name: string]: unknown;
}

export interface Asked {
  method: string;
  path: string;
  body: Body;
}

class Refusal extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    what: string,
    readonly toDo = '',
    readonly more: object = {},
  ) {
    super(what);
  }
}

export class Mock {
  readonly layer = new Layer();
  /** Every write, in order. */
  readonly asked: Asked[] = [];
  accounts = true;
  keyLogin = true;
  /** The file changes under the page's hands with the next apply. */
  changedMeanwhile = false;
  withLobes = true;
  /** Share of the map and of the plan that is computed; 1: all. */
  studied = 1;
  /** In the machine file; an apply changes it. */
  limit_um = 10;
  /** No time passes but by play(). */
  still = false;
  /** Refuses connections, as while the network is down. */
  offline = false;
  private session: { name: string; role: Role } | undefined;
  private readonly server: Server = createServer((request, response) => void this.answer(request, response));
  private readonly sockets = new Set<Socket>();
  private ticker: NodeJS.Timeout | undefined;
  private sent = 0;
  private frames = 0;

  async start(port = 0): Promise<string> {
    this.server.on('upgrade', (request: IncomingMessage, stream: Duplex) => this.upgrade(request, stream));
    await new Promise<void>((ready) => this.server.listen(port, '127.0.0.1', ready));
    this.sent = Date.now();
    this.ticker = setInterval(() => this.tick(), FRAME_MS);
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}`;
  }

  async stop(): Promise<void> {
    clearInterval(this.ticker);
    this.drop();
    this.server.closeAllConnections();
    await new Promise((done) => this.server.close(done));
  }

  /** Pulls the cable of every stream. */
  drop(): void {
    this.sockets.forEach((s) => s.drop());
    this.sockets.clear();
  }

  logIn(role: Role): void {
    this.session = { name: Object.keys(ACCOUNTS).find((n) => ACCOUNTS[n] === role) ?? '', role };
  }

  logOut(): void {
    this.session = undefined;
  }

  sayHello(): void {
    this.sockets.forEach((s) => s.send(this.layer.hello()));
  }

  /** So many frames at once, of 0.2 s each, with their spectra. */
  play(frames: number): void {
    for (let i = 0; i < frames; ++i) {
      const [frame, spectrum] = [this.layer.frame(200), this.layer.spectrum()];
      this.sockets.forEach((s) => {
        s.send(frame);
        s.send(spectrum);
      });
    }
  }

  private tick(): void {
    const now = Date.now();
    const cycles = this.still ? 0 : Math.min(now - this.sent, 200);
    this.sent = now;
    this.frames += 1;
    const frame = this.layer.frame(cycles);
    const spectrum = this.frames % 8 === 0 && !this.still && this.layer.hears ? this.layer.spectrum() : undefined;
    for (const socket of this.sockets) {
      socket.send(frame);
      if (spectrum) socket.send(spectrum);
    }
  }

  private upgrade(request: IncomingMessage, stream: Duplex): void {
    if (this.offline || !this.session || !request.headers.cookie?.includes('steadyrest_session=')) {
      stream.end('HTTP/1.1 401 Unauthorized\r\nConnection: close\r\n\r\n');
      return;
    }
    const socket = accept(request, stream);
    this.sockets.add(socket);
    socket.send(this.layer.hello());
  }

  private async answer(request: IncomingMessage, response: ServerResponse): Promise<void> {
    const url = new URL(request.url ?? '/', 'http://localhost');
    response.setHeader('Content-Security-Policy', CSP);
    response.setHeader('X-Content-Type-Options', 'nosniff');
    response.setHeader('Cross-Origin-Resource-Policy', 'same-origin');
    if (!url.pathname.startsWith('/api/')) {
      this.file(url.pathname, response);
      return;
    }
    try {
      const body = await bodyOf(request);
      const answer = this.route(request, url, body, response);
      response.writeHead(answer === undefined ? 204 : 200, { 'Content-Type': 'application/json' });
      response.end(answer === undefined ? '' : JSON.stringify({ version: 1, ...answer }));
    } catch (error) {
      const { status, code, message, toDo, more } = error instanceof Refusal ? error : new Refusal(400, 'bad_request', String(error));
      response.writeHead(status, { 'Content-Type': 'application/json' });
      response.end(JSON.stringify({ version: 1, error: { code, what: message, to_do: toDo, ...more } }));
    }
  }

  private file(path: string, response: ServerResponse): void {
    const file = join(DIST, path === '/' ? 'index.html' : path);
    if (!existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { 'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream' }).end(readFileSync(file));
  }

  private need(role: Role): void {
    if (!this.session) {
      throw new Refusal(401, 'not_logged_in', 'You are not logged in.', 'Log in.');
    }
    if (RANK[this.session.role] < RANK[role]) {
      throw new Refusal(403, 'role_too_low', `This needs the role ${role}.`);
    }
  }

  private route(request: IncomingMessage, url: URL, body: Body, response: ServerResponse): object | undefined {
    const path = url.pathname.replace('/api/v1/', '');
    const { method = 'GET' } = request;
    if (path === 'session') {
      return this.sessions(method, body, response, request);
    }
    this.need('viewer');
    if (method === 'GET') {
      return this.read(path, url.searchParams, response);
    }
    if (request.headers['x-steadyrest-csrf'] !== CSRF) {
      throw new Refusal(403, 'csrf', 'The request does not come from the page.');
    }
    this.asked.push({ method, path, body });
    return this.write(path, body);
  }

  private sessions(method: string, body: Body, response: ServerResponse, request: IncomingMessage): object | undefined {
    if (method === 'POST') {
      const role = body['key'] === KEY ? 'engineer' : body['password'] === 'right' ? ACCOUNTS[String(body['name'])] : undefined;
      if (!role) {
        throw new Refusal(401, 'wrong_password', body['key'] === undefined ? 'Name or password is wrong.' : 'This key is wrong.', 'Try again.');
      }
      this.logIn(role);
      response.setHeader('Set-Cookie', 'steadyrest_session=mock; HttpOnly; SameSite=Strict; Path=/');
    } else if (method === 'DELETE') {
      this.session = undefined;
      return undefined;
    }
    const known = method === 'POST' || request.headers.cookie?.includes('steadyrest_session=');
    return { session: known && this.session ? { ...this.session, csrf: CSRF } : null, accounts: this.accounts, key_login: this.keyLogin };
  }

  private read(path: string, query: URLSearchParams, response: ServerResponse): object {
    const [first, name, what] = path.split('/');
    if (first === 'records' && name !== undefined) {
      if (what === 'data') return recordData(query);
      if (what === 'export') {
        response.setHeader('Content-Disposition', `attachment; filename="record.${query.get('format')}"`);
        return { t_s: [] };
      }
      const damaged = RECORDS.find((r) => r.name === decodeURIComponent(name) && 'damaged' in r);
      if (damaged) throw new Refusal(422, 'refused', 'The record cannot be read: file is not a database.');
      return { record: record() };
    }
    switch (path) {
      case 'status':
        return { status: this.layer.status() };
      case 'machine':
        return { machine: machine(this.limit_um) };
      case 'thermal':
        return { thermal: thermal() };
      case 'motion':
        return { motion: { axes: encoders() } };
      case 'chatter/lobes':
        if (!this.withLobes) throw new Refusal(404, 'not_found', 'There is no map.', 'Start with --process FILE.');
        return { lobes: this.studied < 1 ? null : lobes(), progress: this.studied };
      case 'chatter/plan':
        return { plan: this.studied < 1 ? null : plan(), programmed_rpm: 5200, progress: this.studied };
      case 'records':
        return { records: RECORDS.filter((r) => JSON.stringify(r).includes(query.get('search') ?? '')) };
    }
    throw new Refusal(404, 'not_found', `There is no ${path}.`);
  }

  private modulate({ law, amplitude_ratio, period_s, mean_ratio }: Modulation): Modulation {
    this.layer.modulation = { law, amplitude_ratio, period_s, mean_ratio };
    this.sayHello();
    return this.layer.modulation;
  }

  private write(path: string, body: Body): object {
    if (MOVES.includes(path) && this.layer.wanted === 'act' && body['confirm'] !== true) {
      throw new Refusal(422, 'refused', 'In mode act this moves the machine at once.', 'Send "confirm": true.');
    }
    switch (path) {
      case 'hand-back':
        this.layer.wanted = 'observe';
        return { mode_wanted: 'observe' };
      case 'mode':
        this.need('operator');
        if (body['mode'] === 'act' && body['confirm'] !== true) throw new Refusal(422, 'refused', 'act needs confirm.');
        this.layer.wanted = body['mode'] as 'act';
        return { mode_wanted: body['mode'] };
      case 'modulation':
        this.need('operator');
        if (Number(body['amplitude_ratio']) > 0.9) throw new Refusal(422, 'refused', '`amplitude_ratio` is out of range; allowed: 0 … 0.9');
        return { modulation: this.modulate(body as unknown as Modulation) };
      case 'thermal/measured':
        this.need('operator');
        return { verdict: Math.abs(Number(body['displacement_um'])) > 30 ? { taken: false, reason: 'thermal_reading_outlier', sentence: 'A probe reading too far from the forecast was rejected.' } : { taken: true, reason: 'thermal_reading_taken', sentence: 'A probe reading re-zeroed the thermal model.' } };
      case 'machine/check':
        return checked(body);
      case 'machine/apply':
        this.need('engineer');
        if (this.changedMeanwhile) {
          this.changedMeanwhile = false;
          throw new Refusal(409, 'changed_meanwhile', 'The file has changed.');
        }
        this.limit_um = Number((body['changes'] as Body | undefined)?.['contour.limit_um'] ?? this.limit_um);
        this.sayHello();
        return { reload: { number: 3, utc: '2026-01-02T03:04:05Z', outcome: 'taken', words: '' } };
    }
    if (path.endsWith('/replay')) {
      this.need('engineer');
      return { cycles: 1_834_000, first_difference: null };
    }
    throw new Refusal(404, 'not_found', `There is no ${path}.`);
  }
}

async function bodyOf(request: IncomingMessage): Promise<Body> {
  const parts: Buffer[] = [];
  for await (const part of request) {
    parts.push(part as Buffer);
  }
  const text = Buffer.concat(parts).toString();
  if (text !== '' && request.headers['content-type'] !== 'application/json') {
    throw new Refusal(415, 'unsupported_media_type', 'Send JSON.');
  }
  return text === '' ? {} : (JSON.parse(text) as Body);
}
