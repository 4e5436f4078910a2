// SPDX-License-Identifier: Apache-2.0
// The server's side of a WebSocket, as far as the mock needs it: text frames out, nothing but a close in.
import { createHash } from 'node:crypto';
import type { IncomingMessage } from 'node:http';
import type { Duplex } from 'node:stream';

const GUID = '258EAFA5-E914-47DA-95CA-C5AB0DC85B11';
const TEXT = 0x81;
const CLOSE = 0x8;

export function textFrame(text: string): Buffer {
  const body = Buffer.from(text);
  const head = Buffer.alloc(body.length < 126 ? 2 : body.length < 65_536 ? 4 : 10);
  head[0] = TEXT;
  if (body.length < 126) {
    head[1] = body.length;
  } else if (body.length < 65_536) {
    head[1] = 126;
    head.writeUInt16BE(body.length, 2);
  } else {
    head[1] = 127;
    head.writeBigUInt64BE(BigInt(body.length), 2);
  }
  return Buffer.concat([head, body]);
}

export class Socket {
  open = true;

  constructor(private readonly stream: Duplex) {
    stream.on('data', (data: Buffer) => {
      if (((data[0] ?? 0) & 0xf) === CLOSE) {
        this.drop();
      }
    });
    for (const event of ['close', 'error', 'end']) {
      stream.on(event, () => (this.open = false));
    }
  }

  /** A client that does not take its data gets no more, as from the real server. */
  send(message: object): boolean {
    if (!this.open || this.stream.writableLength > 0) {
      return false;
    }
    this.stream.write(textFrame(JSON.stringify(message)));
    return true;
  }

  /** Without a closing frame, like a cable that is pulled. */
  drop(): void {
    this.open = false;
    this.stream.destroy();
  }
}

export function accept(request: IncomingMessage, stream: Duplex): Socket {
  const key = createHash('sha1').update(`${request.headers['sec-websocket-key']}${GUID}`).digest('base64');
  stream.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${key}\r\n\r\n`);
  return new Socket(stream);
}
