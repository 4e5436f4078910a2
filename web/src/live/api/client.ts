// SPDX-License-Identifier: Apache-2.0
import type { Refusal, SessionAnswer } from './types';

/** What the server answered instead of the thing asked for. */
export class ApiError extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    what: string,
    readonly toDo: string,
    readonly refusals: readonly Refusal[],
  ) {
    super(what);
  }
}

const BASE = '/api/v1/';
const PATIENCE_MS = 15_000;
/** A long record is thinned before its course can be shown, and replayed cycle by cycle. */
export const RECORD_PATIENCE_MS = 30 * 60_000;

interface Failure {
  error?: { code?: string; what?: string; to_do?: string; refusals?: Refusal[] };
  refusals?: Refusal[];
}

async function failure(answer: Response): Promise<ApiError> {
  let body: Failure = {};
  try {
    body = (await answer.json()) as Failure;
  } catch {
    // Not from the API: a proxy, for one. The status says enough.
  }
  const { code = '', what = `${answer.status} ${answer.statusText}`, to_do = '', refusals } = body.error ?? {};
  return new ApiError(answer.status, code, what, to_do, refusals ?? body.refusals ?? []);
}

/** The HTTP interface, as the session that is logged in. */
export class Api {
  private csrf = '';
  /** Called when the server no longer knows the session. */
  onLoggedOut: () => void = () => {};

  async get<T>(path: string, patience_ms = PATIENCE_MS): Promise<T> {
    return this.ask<T>('GET', path, undefined, patience_ms);
  }

  async post<T>(path: string, body: object = {}, patience_ms = PATIENCE_MS): Promise<T> {
    return this.ask<T>('POST', path, body, patience_ms);
  }

  async session(): Promise<SessionAnswer> {
    return this.keep(await this.get<SessionAnswer>('session'));
  }

  /** By name and password, or by the key that the program printed. */
  async logIn(by: { name: string; password: string } | { key: string }): Promise<SessionAnswer> {
    return this.keep(await this.post<SessionAnswer>('session', by));
  }

  async logOut(): Promise<void> {
    await this.ask('DELETE', 'session');
    this.csrf = '';
  }

  private keep(answer: SessionAnswer): SessionAnswer {
    this.csrf = answer.session?.csrf ?? '';
    return answer;
  }

  private async ask<T>(method: string, path: string, body?: object, patience_ms = PATIENCE_MS): Promise<T> {
    const headers: Record<string, string> = { Accept: 'application/json' };
    if (method !== 'GET') {
      headers['Content-Type'] = 'application/json';
      headers['X-Steadyrest-CSRF'] = this.csrf;
    }
    const answer = await fetch(BASE + path, {
      method,
      headers,
      credentials: 'same-origin',
      signal: AbortSignal.timeout(patience_ms),
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    if (!answer.ok) {
      const error = await failure(answer);
      if (error.code === 'not_logged_in') {
        this.onLoggedOut();
      }
      throw error;
    }
    return answer.status === 204 ? (undefined as T) : ((await answer.json()) as T);
  }
}
