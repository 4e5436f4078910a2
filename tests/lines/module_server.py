# SPDX-License-Identifier: Apache-2.0
"""An I/O module for tests: pymodbus answers the Modbus side, the test is what its terminals are wired to.

  module_server.py tcp            on a free port of 127.0.0.1
  module_server.py serial DEVICE  RTU

Prints `ready PORT` (serial: `ready 0`). Then one line in, one line out:
  INPUTS NOW    levels of the inputs as a hexadecimal number, the machine's time in seconds
  → OUTPUTS N R  levels of the outputs likewise, how many times they were written, and inputs read
  watchdog S    the outputs drop when they were not written for S seconds of the machine's time
  latch         a watchdog that has expired keeps the outputs off until 0xBECF, then 0xAFFE is
                written to register 4385; `latch mute`: and readings are answered with exception 4
  stick LINE L  output LINE stays at level L whatever is written
  join A:B …    output A is joined to input B, by a jumper
  hang          answers no Modbus request any more
"""
import asyncio
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartAsyncSerialServer, StartAsyncTcpServer
from pymodbus.transaction import ModbusRtuFramer

LINES = 64


class Terminals:
    """Levels of all lines, in the machine's time."""

    def __init__(self):
        self.inputs = 0
        self.outputs = 0
        self.written = 0
        self.reads = 0
        self.now = 0.0
        self.last = 0.0
        self.watchdog = 0.0
        self.latches = False
        self.mute = False
        self.latched = False
        self.stuck = {}
        self.jumpers = []
        self.hangs = False

    def write(self, first, levels):
        for i, level in enumerate(levels):
            bit = 1 << (first + i)
            self.outputs = self.outputs | bit if level else self.outputs & ~bit
        if self.latched:
            self.outputs = 0
        self.written += 1
        self.last = self.now
        self.hold()

    def hold(self):
        for line, level in self.stuck.items():
            self.outputs = self.outputs | 1 << line if level else self.outputs & ~(1 << line)
        for output, line in self.jumpers:
            level = self.outputs >> output & 1
            self.inputs = self.inputs | 1 << line if level else self.inputs & ~(1 << line)

    def tick(self, inputs, now):
        self.inputs = inputs
        self.now = now
        self.hold()
        if self.watchdog > 0 and now - self.last > self.watchdog:
            self.outputs = 0
            self.latched = self.latches
            self.hold()


class Block(ModbusSequentialDataBlock):
    """Lines as bits (`width` 1) or as registers (16); `out` can be written."""

    def __init__(self, terminals, width, out):
        super().__init__(0, [0] * LINES)
        self.terminals = terminals
        self.width = width
        self.out = out

    def validate(self, address, count=1):
        return 0 <= address and (address + count) * self.width <= LINES

    def getValues(self, address, count=1):
        if self.terminals.mute and self.terminals.latched:
            raise RuntimeError("the watchdog has expired")  # pymodbus answers with exception 4
        self.terminals.reads += 0 if self.out else 1
        word = self.terminals.outputs if self.out else self.terminals.inputs
        return [word >> (self.width * (address + i)) & ((1 << self.width) - 1) for i in range(count)]

    def setValues(self, address, values):
        levels = [bool(value >> bit & 1) for value in values for bit in range(self.width)]
        self.terminals.write(self.width * address, levels)


class Registers(Block):
    """Output registers, with registers of its own from 4384 on, as the watchdog of some modules."""

    def __init__(self, terminals):
        super().__init__(terminals, 16, True)
        self.own = {}

    def validate(self, address, count=1):
        return address >= 4384 or super().validate(address, count)

    def getValues(self, address, count=1):
        if address < 4384:
            return super().getValues(address, count)
        return [self.own.get(address + i, 0) for i in range(count)]

    def setValues(self, address, values):
        if address < 4384:
            super().setValues(address, values)
            return
        for i, value in enumerate(values):
            if address + i == 4385 and value == 0xAFFE and self.own.get(4385) == 0xBECF:
                self.terminals.latched = False
            # 4386 can be read only, as registers are while a watchdog runs.
            if address + i != 4386:
                self.own[address + i] = value
        self.terminals.watchdog = self.own.get(4384, 0) / 1000.0


def answer(terminals, words):
    if words[0] == "watchdog":
        terminals.watchdog = float(words[1])
    elif words[0] == "latch":
        terminals.latches = True
        terminals.mute = words[1:] == ["mute"]
    elif words[0] == "stick":
        terminals.stuck[int(words[1])] = int(words[2])
        terminals.hold()
    elif words[0] == "join":
        terminals.jumpers = [tuple(map(int, word.split(":"))) for word in words[1:]]
        terminals.hold()
    elif words[0] == "hang":
        terminals.hangs = True
    else:
        terminals.tick(int(words[0], 16), float(words[1]))
    return f"{terminals.outputs:x} {terminals.written} {terminals.reads}"


def hanging(terminals):
    """No answer goes out while the module hangs."""

    def manipulate(response):
        if terminals.hangs:
            response.should_respond = False
        return response, False

    return manipulate


async def main():
    terminals = Terminals()
    slave = ModbusSlaveContext(
        di=Block(terminals, 1, False),
        co=Block(terminals, 1, True),
        ir=Block(terminals, 16, False),
        hr=Registers(terminals),
        zero_mode=True,
    )
    context = ModbusServerContext(slaves=slave, single=True)
    if sys.argv[1] == "tcp":
        server = await StartAsyncTcpServer(
            context=context,
            address=("127.0.0.1", 0),
            defer_start=True,
            allow_reuse_address=True,
            response_manipulator=hanging(terminals),
        )
        asyncio.ensure_future(server.serve_forever())
        await server.serving
        port = server.server.sockets[0].getsockname()[1]
    else:
        server = await StartAsyncSerialServer(
            context=context,
            framer=ModbusRtuFramer,
            port=sys.argv[2],
            baudrate=115200,
            defer_start=True,
            response_manipulator=hanging(terminals),
        )
        await server.start()
        port = 0
    print(f"ready {port}", flush=True)
    reader = asyncio.StreamReader()
    loop = asyncio.get_running_loop()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    while line := await reader.readline():
        sys.stdout.write(answer(terminals, line.decode().split()) + "\n")
        sys.stdout.flush()


asyncio.run(main())
