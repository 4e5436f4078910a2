// SPDX-License-Identifier: Apache-2.0
import type { Message } from './types';

const FIRST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 5000;
/** Frames come 30 times a second: a silence this long is a lost connection that nobody has told us of. */
const SILENCE_MS = 3000;

export interface StreamEvents {
  message: (message: Message) => void;
  up: () => void;
  down: () => void;
  /** Asked before each new attempt: false ends them (nobody is logged in). */
  mayReconnect: () => Promise<boolean>;
}

/** The wait before the n-th attempt, from 0. */
export function waitBefore(attempt: number): number {
  return Math.min(FIRST_WAIT_MS * 2 ** attempt, LONGEST_WAIT_MS);
}

/** The stream of the layer; a connection that drops is opened again. */
export class Stream {
  private socket: WebSocket | undefined;
  private timer = 0;
  private silence = 0;
  private attempt = 0;
  private ended = false;

  constructor(private readonly events: StreamEvents) {}

  open(): void {
    const socket = new WebSocket(`${window.location.protocol === 'https:' ? 'wss' : 'ws'}://${window.location.host}/api/v1/stream`);
    this.socket = socket;
    this.watchSilence();
    socket.addEventListener('message', (event) => {
      if (socket !== this.socket || typeof event.data !== 'string') {
        return;
      }
      if (this.attempt !== -1) {
        this.attempt = -1;
        this.events.up();
      }
      this.watchSilence();
      this.events.message(JSON.parse(event.data) as Message);
    });
    socket.addEventListener('close', () => this.lost(socket));
  }

  close(): void {
    this.ended = true;
    window.clearTimeout(this.timer);
    window.clearTimeout(this.silence);
    this.socket?.close();
    this.socket = undefined;
  }

  private watchSilence(): void {
    window.clearTimeout(this.silence);
    this.silence = window.setTimeout(() => {
      const socket = this.socket;
      socket?.close();
      if (socket) {
        // A dead link may take minutes to report the close.
        this.lost(socket);
      }
    }, SILENCE_MS);
  }

  private lost(socket: WebSocket): void {
    if (this.ended || socket !== this.socket) {
      return;
    }
    this.socket = undefined;
    window.clearTimeout(this.silence);
    this.attempt += this.attempt === -1 ? 1 : 0;
    this.events.down();
    this.timer = window.setTimeout(() => void this.again(), waitBefore(this.attempt));
  }

  private async again(): Promise<void> {
    this.attempt += 1;
    const may = await this.events.mayReconnect();
    if (may && !this.ended) {
      this.open();
    }
  }
}
