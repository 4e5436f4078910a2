#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How long a hand-back by the page takes while others flood it.

Starts the layer on the simulated machine in mode act, floods its page from addresses of 127.0.0.0/8 in processes of
their own, and hands back twenty times a second by a new connection each. Bounded in time and count; all on loopback.

    bench/live/page_floods.py build/release/bin/steadyrest [--seconds 4] [--only NAME]

Prints one line of JSON for each flood: hand-backs, those that were not answered with 200, and the milliseconds from
connect() to the answer: median, p99, worst. Exit 1 where a hand-back failed or took longer than --limit-ms.
"""
import argparse
import base64
import itertools
import json
import multiprocessing
import os
import pathlib
import re
import socket
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_HELD = 400  # sockets of one flooding process


def connected(port, source):
    s = socket.socket()
    s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    s.bind((source, 0))
    s.settimeout(1)
    s.connect(("127.0.0.1", port))
    return s


def head(line, port, more=""):
    return f"{line} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n{more}"


def held(port, until, sources, text):
    """Connections that say `text` and read nothing."""
    sockets = []
    for n in itertools.count():
        if time.time() >= until:
            break
        try:
            s = connected(port, sources(n))
            s.setblocking(False)
            s.send(text)
            sockets.append(s)
        except OSError:
            time.sleep(0.001)
        if len(sockets) > MOST_HELD:
            sockets.pop(0).close()


def asked(port, until, sources, text):
    """Connections that say `text` and read the answer, one after the other."""
    for n in itertools.count():
        if time.time() >= until:
            break
        try:
            with connected(port, sources(n)) as s:
                s.sendall(text)
                while s.recv(65536):
                    pass
        except OSError:
            time.sleep(0.001)


def one(address):
    return lambda n: address


def many(net):
    start = os.getpid() * 7919
    return lambda n: f"127.{net}.{(start + n) // 250 % 250}.{1 + (start + n) % 250}"


def body(method, path, port, text, more=""):
    more += "Content-Type: application/json\r\nConnection: close\r\n"
    return head(f"{method} {path}", port, f"{more}Content-Length: {len(text)}\r\n\r\n").encode() + text


def login(port, until, sources):
    for n in itertools.count():
        if time.time() >= until:
            break
        text = json.dumps({"name": f"user{n % 1000}", "password": f"guess {n} {os.getpid()}"}).encode()
        asked(port, min(until, time.time() + 0.001), lambda _, n=n: sources(n), body("POST", "/api/v1/session", port, text))


def floods(token):
    large = lambda port: head("GET /live.js", port, "\r\n").encode() * 5
    page = lambda port: head("GET /live.js", port, "Connection: close\r\n\r\n").encode()
    half = lambda port: head("POST /api/v1/session", port, "Content-Length: 200000\r\nContent-Type: applic").encode()
    key = base64.b64encode(b"0123456789abcdef").decode()
    stream = lambda port: head("GET /api/v1/stream", port, "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                               f"Sec-WebSocket-Key: {key}\r\nAuthorization: Bearer {token}\r\n\r\n").encode()
    heavy = lambda port: body("POST", "/api/v1/machine/check", port, b'{"text":"' + b"x" * 250_000 + b'"}', f"Authorization: Bearer {token}\r\n")
    guess = lambda port: body("POST", "/api/v1/hand-back", port, b"{}", "Authorization: Bearer none\r\n")
    return {
        "none": (0, lambda port, until: None),
        "one that never reads": (2, lambda port, until: held(port, until, one("127.66.0.1"), large(port))),
        "many that never read": (2, lambda port, until: held(port, until, many(67), large(port))),
        "slow writers": (2, lambda port, until: held(port, until, many(68), half(port))),
        "idle connections": (2, lambda port, until: held(port, until, many(69), b"")),
        "log-ins": (40, lambda port, until: login(port, until, many(70))),
        "log-ins of one address": (8, lambda port, until: login(port, until, one("127.71.0.1"))),
        "pages": (4, lambda port, until: asked(port, until, many(72), page(port))),
        "streams that never read": (2, lambda port, until: held(port, until, many(73), stream(port))),
        "large requests": (4, lambda port, until: asked(port, until, many(74), heavy(port))),
        "hand-backs of strangers": (4, lambda port, until: asked(port, until, many(75), guess(port))),
    }


def aside(flood, port, until):
    os.nice(10)  # a flood comes from other computers: it does not take the layer's
    flood(port, until)


def hand_backs(port, token, until):
    times, bad = [], 0
    text = body("POST", "/api/v1/hand-back", port, b"{}", f"Authorization: Bearer {token}\r\n")
    while time.time() < until:
        begun = time.perf_counter()
        try:
            with connected(port, "127.0.0.1") as s:
                s.sendall(text)
                got = s.recv(4096)
        except OSError:
            got = b""
        times.append(1e3 * (time.perf_counter() - begun))
        bad += not got.startswith(b"HTTP/1.1 200")
        time.sleep(0.05)
    return times, bad


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--limit-ms", type=float, default=50.0)
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: os.path.join(folder, name)
        users = ["--users", at("users.json")]
        made = json.loads(subprocess.run([program, "page", "add-token", "bench", "--role", "operator", "--json", *users], check=True, capture_output=True, text=True).stdout)
        subprocess.run([program, "page", "add-user", "anna", "--role", "operator", *users], input="a long password\n", check=True, capture_output=True, text=True)
        run = subprocess.Popen([program, "run", "--machine", "examples/machines/vmc-840d.toml", "--program", "examples/programs/rib-pocket.mpf", "--repeat", "--mode", "act",
                                "--socket", at("s"), "--listen", "0", *users], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        try:
            port = None
            for line in run.stderr:
                if found := re.match(r"Page: http://127\.0\.0\.1:(\d+)/", line):
                    port = int(found[1])
                    break
            for name, (processes, flood) in floods(made["token"]).items():
                if options.only not in name:
                    continue
                until = time.time() + options.seconds
                work = [multiprocessing.Process(target=aside, args=(flood, port, until), daemon=True) for _ in range(processes)]
                for one_of in work:
                    one_of.start()
                time.sleep(0.5)
                times, bad = hand_backs(port, made["token"], until)
                for one_of in work:
                    one_of.join()
                times.sort()
                print(json.dumps({"flood": name, "hand_backs": len(times), "failed": bad, "p50_ms": round(statistics.median(times), 1),
                                  "p99_ms": round(times[int(0.99 * (len(times) - 1))], 1), "worst_ms": round(times[-1], 1)}), flush=True)
                failed |= bad > 0 or times[-1] > options.limit_ms
        finally:
            run.terminate()
            run.wait()
    return failed


if __name__ == "__main__":
    sys.exit(main())
