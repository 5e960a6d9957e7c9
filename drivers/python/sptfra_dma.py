# SPDX-License-Identifier: MIT OR Apache-2.0
"""Frames through an AXI DMA, one at a time or, where it has descriptors, in batches (AMD's PG021).

Both classes have `exchange` and `recover`; `Sptfra` chooses.
"""

import time

import numpy as np

#: More packets than a core holds.
MOST_PACKETS = 32
#: Before the core counts as empty.
LEAST_POLLS = 1000

#: Registers of either channel, and bits of its control and status.
SEND, RECEIVE = 0x00, 0x30
CONTROL, STATUS, FIRST, LAST = 0x00, 0x04, 0x08, 0x10
RUN, RESET = 1, 4
HALTED, HAS_DESCRIPTORS, FAULTS = 1, 8, 0x770

#: Words of a descriptor, and bits of its last two.
NEXT, ADDRESS, LENGTH, RESULT = 0, 2, 6, 7
DESCRIPTOR_WORDS = 16
PACKET_END, PACKET_START = 1 << 26, 1 << 27
COMPLETE, DESCRIPTOR_FAULTS, LENGTH_MASK = 1 << 31, 0x70000000, 0x03FFFFFF
LINE = 64


class Transfers:
    """What both ways have in common: the DMA, and how long to wait for it."""

    def __init__(self, dma, allocate, identity):
        self._dma, self._allocate, self._identity = dma, allocate, identity

    def _reset(self, timeout):
        # A reset on either channel resets both.
        self._dma.write(SEND + CONTROL, RESET)
        self._until(lambda: not self._dma.read(SEND + CONTROL) & RESET, timeout)

    def _until(self, reached, timeout, polls=0):
        """Waits so many seconds, and asks so many times at least: a simulated core lives by being asked."""
        end = time.monotonic() + timeout
        while not reached():
            if self._stopped():
                raise RuntimeError("the DMA stopped with an error: recover()")
            polls -= 1
            if polls < 0 and time.monotonic() > end:
                raise TimeoutError(f"nothing came in {timeout} s: recover()")

    def _stopped(self):
        return (self._dma.read(SEND + STATUS) | self._dma.read(RECEIVE + STATUS)) & FAULTS

    def _drain(self, packet, timeout):
        """Takes packets by `packet` until none comes in so many seconds."""
        try:
            for _ in range(MOST_PACKETS):
                packet()
        except TimeoutError:
            self.reset(timeout)
            return
        raise RuntimeError(f"the core is not empty after {MOST_PACKETS} packets: reset it by its aresetn")


class OneByOne(Transfers):
    """A transfer each way for each frame, by the channels that PYNQ's DMA has without descriptors."""

    def __init__(self, dma, allocate, identity):
        super().__init__(dma, allocate, identity)
        samples = identity.samples
        self._stress = allocate(shape=(4 * identity.words_in // samples.itemsize,), dtype=samples)
        self._forces = allocate(shape=(identity.words_out,), dtype=np.uint32)
        self._beat = allocate(shape=(identity.stream_bits // 32,), dtype=np.uint32)

    def reset(self, timeout):
        self._reset(timeout)
        self._dma.sendchannel.start()
        self._dma.recvchannel.start()

    def exchange(self, frames, check, timeout):
        """Answers (n, words_out) to frames (n, taxels); each is checked, `check(answers)`, before the next frame goes."""
        answers = np.empty((len(frames), self._identity.words_out), dtype=np.uint32)
        send, receive = self._dma.sendchannel, self._dma.recvchannel
        for place, frame in enumerate(frames):
            self._stress[: len(frame)] = frame
            self._stress.flush()
            receive.transfer(self._forces)
            send.transfer(self._stress)
            self._until(lambda: send.idle and receive.idle, timeout)
            self._forces.invalidate()
            answers[place] = self._forces
            check(answers[place : place + 1])
        return answers

    def recover(self, soft_reset, timeout):
        self.reset(timeout)
        soft_reset()
        self._beat[:] = 0
        self._beat.flush()
        # A beat with TLAST: the end of a packet that the reset has cut, else a bad frame of its own.
        self._dma.sendchannel.transfer(self._beat)

        def packet():
            self._dma.recvchannel.transfer(self._forces)
            self._until(lambda: self._dma.recvchannel.idle, timeout, LEAST_POLLS)

        self._drain(packet, timeout)


class Half:
    """Half of the rings: descriptors and memory of a batch, which the DMA has or the processor, never both."""

    def __init__(self, allocate, identity, frames):
        samples = identity.samples
        self.frames = frames
        self.bytes_in, self.bytes_out = 4 * identity.words_in, 4 * identity.words_out
        # Each frame begins on a line, as the DMA wants it on a beat.
        stride_in, stride_out = (-(-size // LINE) * LINE for size in (self.bytes_in, self.bytes_out))
        self.stress = allocate(shape=(frames, stride_in // samples.itemsize), dtype=samples)
        self.forces = allocate(shape=(frames, stride_out // 4), dtype=np.uint32)
        self.stress[:] = 0
        self.rings = {}
        for channel, memory, stride in ((SEND, self.stress, stride_in), (RECEIVE, self.forces, stride_out)):
            ring = allocate(shape=(frames, DESCRIPTOR_WORDS), dtype=np.uint32)
            if ring.device_address % LINE or memory.device_address % LINE:
                raise RuntimeError(f"the memory begins on no multiple of {LINE} bytes: pynq.allocate's does")
            ring[:] = 0
            put_addresses(ring[:, ADDRESS : ADDRESS + 2], memory.device_address + stride * np.arange(frames))
            self.rings[channel] = ring

    def place(self, channel, index):
        """Bus address of a descriptor."""
        return self.rings[channel].device_address + 4 * DESCRIPTOR_WORDS * index

    def renew(self, channel, count, after, length):
        """Makes so many descriptors new, for transfers of so many bytes; behind them comes the half `after`."""
        ring = self.rings[channel]
        following = [self.place(channel, index) for index in range(1, count)] + [after.place(channel, 0)]
        put_addresses(ring[:count, NEXT : NEXT + 2], np.array(following))
        ring[:count, LENGTH] = length | (PACKET_START | PACKET_END if channel == SEND else 0)
        ring[:count, RESULT] = 0
        ring.flush()

    def results(self, channel, count):
        """What has become of the first descriptors."""
        self.rings[channel].invalidate()
        return np.array(self.rings[channel][:count, RESULT])


def put_addresses(words, addresses):
    """Writes 64-bit addresses to pairs of words, the lower first."""
    addresses = np.asarray(addresses, dtype=np.uint64)
    words[:, 0] = addresses & np.uint64(0xFFFFFFFF)
    words[:, 1] = addresses >> np.uint64(32)


class Batches(Transfers):
    """Two batches of frames: one on its way through the core while the other is written and read."""

    def __init__(self, dma, allocate, identity, frames):
        super().__init__(dma, allocate, identity)
        if frames < 1:
            raise ValueError(f"a queue of {frames} frames: give at least 1")
        if identity.drops_frames:
            raise RuntimeError("the core drops frames: nobody could tell whose answers are whose; send them one at a time")
        self._halves = [Half(allocate, identity, frames) for _ in range(2)]
        self._next = 0
        self.reset(1.0)

    def reset(self, timeout):
        """Resets the DMA, and lets both channels wait at the beginning of the first half."""
        self._reset(timeout)
        if not self._dma.read(SEND + STATUS) & HAS_DESCRIPTORS:
            raise RuntimeError("the DMA has no descriptors: make the system with the word queue (docs/how-to/vivado.md)")
        self._next = 0
        for channel in (SEND, RECEIVE):
            self._write_address(channel + FIRST, self._halves[0].place(channel, 0))
            self._dma.write(channel + CONTROL, RUN)
            self._until(lambda channel=channel: not self._dma.read(channel + STATUS) & HALTED, timeout)

    def _write_address(self, offset, address):
        self._dma.write(offset, address & 0xFFFFFFFF)
        self._dma.write(offset + 4, address >> 32)

    def _stopped(self):
        return (self._dma.read(SEND + STATUS) | self._dma.read(RECEIVE + STATUS)) & (FAULTS | HALTED)

    def _offer(self, half, count, bytes_in, send=True):
        """Lets the DMA take answers, and frames, by the first descriptors of a half."""
        after = self._halves[1 - self._next]
        half.renew(RECEIVE, count, after, half.bytes_out)
        # Nothing may be written over the answers later.
        half.forces.flush()
        self._write_address(RECEIVE + LAST, half.place(RECEIVE, count - 1))
        half.renew(SEND, count, after, bytes_in)
        if send:
            self._write_address(SEND + LAST, half.place(SEND, count - 1))

    def exchange(self, frames, check, timeout):
        """Answers (n, words_out) to frames (n, taxels); `check(answers)` is called for each batch of them in turn."""
        answers = np.empty((len(frames), self._identity.words_out), dtype=np.uint32)
        size = self._halves[0].frames
        under_way = None
        for begin in range(0, len(frames), size):
            half, batch = self._halves[self._next], frames[begin : begin + size]
            half.stress[: len(batch), : frames.shape[1]] = batch
            half.stress.flush()
            self._offer(half, len(batch), half.bytes_in)
            self._next = 1 - self._next
            if under_way is not None:
                self._collect(*under_way, check, timeout)
            under_way = half, answers[begin : begin + len(batch)]
        if under_way is not None:
            self._collect(*under_way, check, timeout)
        return answers

    def _collect(self, half, answers, check, timeout):
        count = len(answers)

        def arrived():
            sent, received = half.results(SEND, count), half.results(RECEIVE, count)
            if np.any((sent | received) & DESCRIPTOR_FAULTS):
                raise RuntimeError("the DMA stopped with an error: recover()")
            return bool(np.all(sent & received & COMPLETE))

        # As long for each frame as for one alone.
        self._until(arrived, timeout * count)
        received = half.results(RECEIVE, count)
        whole = PACKET_START | PACKET_END
        if np.any(received & LENGTH_MASK != half.bytes_out) or np.any(received & whole != whole):
            raise RuntimeError("an answer has another length than the core's: recover()")
        half.forces.invalidate()
        answers[:] = half.forces[:count, : answers.shape[1]]
        check(answers)

    def recover(self, soft_reset, timeout):
        self.reset(timeout)
        soft_reset()
        half = self._halves[0]
        half.stress[0, :] = 0
        half.stress.flush()
        # A beat with TLAST, as above, and then one answer after the other by the first descriptor of either half.
        self._offer(half, 1, self._identity.stream_bits // 8)

        def packet():
            half = self._halves[self._next]
            self._until(lambda: bool(half.results(RECEIVE, 1)[0] & COMPLETE), timeout, LEAST_POLLS)
            self._next = 1 - self._next
            self._offer(self._halves[self._next], 1, 0, send=False)

        self._drain(packet, timeout)
