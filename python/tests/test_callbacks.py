# SPDX-License-Identifier: GPL-3.0-or-later
import os
import signal
import threading
import time

import numpy as np
import pytest

import hr2d


def size(batch):
    return np.maximum(batch.first["length"], batch.second["length"]) / batch.distance


def same(s, other):
    return len(s.elements) == len(other.elements) and np.array_equal(s.B, other.B)


def test_an_oracle_in_python_makes_the_same_links(plates):
    own = plates.solve(epsilon=.21, oracle=size)
    assert same(own, plates.solve(epsilon=.21, oracle="size"))
    assert not same(own, plates.solve(epsilon=.21, oracle="size2"))


def test_batches_may_be_kept(room):
    kept = []

    def oracle(batch):
        kept.append(batch)
        # Among its pairs, those that may see each other only in part have twice the error.
        return size(batch) * (1 + batch.partial)

    s = room.solve(epsilon=.3, oracle=oracle)
    assert same(s, room.solve(epsilon=.3, oracle="size"))
    assert sum(len(batch) for batch in kept) > 100
    assert any(batch.partial.any() for batch in kept)
    first = kept[0]
    assert first.epsilon == .3 and first.unit == room.unit and first.brightness is None
    assert (first.first["patch"] < 7).all() and first.pairs.shape == (len(first), 2)


def test_a_directed_oracle_gets_brightness(plates):
    class Bright(hr2d.Oracle):
        name, symmetric, needs_brightness = "bright", False, True
        seen = []

        def estimate(self, batch):
            self.seen.append(batch.brightness)
            return batch.brightness * size(batch)

    s = plates.solve(epsilon=.3, oracle=Bright())
    light = np.concatenate(Bright.seen)
    assert light.max() == 1 and light.min() == 0 and s.B[1, 0] > .2


def test_policies_in_python(plates):
    class Modified(hr2d.Policy):
        def preferred_subdivision(self, batch):
            return np.full(len(batch), hr2d.SPLIT_BOTH)

    class Level(hr2d.Policy):
        def acceptable(self, batch, error):
            return error < 0

        def recursion_limit(self, batch):
            return np.maximum(batch.first["length"], batch.second["length"]) < .2

    assert same(plates.solve(epsilon=.2, policy=Modified()),
                plates.solve(epsilon=.2, policy="modified"))
    assert plates.solve(policy=Level()).elements["length"].min() == pytest.approx(.125)


def test_exceptions_pass_through(plates):
    class Own(Exception):
        pass

    def broken(batch):
        raise Own("here")

    with pytest.raises(Own, match="here"):
        plates.solve(oracle=broken)
    with pytest.raises(Own):
        plates.solve(epsilon=1e-5, progress=broken)
    with pytest.raises(ValueError, match="pairs need"):
        plates.solve(oracle=lambda batch: 1.0)
    with pytest.raises(hr2d.CallbackError, match="nan|NaN"):
        plates.solve(oracle=lambda batch: np.full(len(batch), np.nan))
    assert plates.solve(oracle=size).B[1, 0] > .2


def test_a_policy_that_gives_nonsense(plates):
    class Nonsense(hr2d.Policy):
        def preferred_subdivision(self, batch):
            return np.full(len(batch), 7)

    with pytest.raises(ValueError, match="SPLIT"):
        plates.solve(policy=Nonsense())


# Without an end: ε = 0 down to level 24 are 10^14 links.
ENDLESS = {"epsilon": 0, "max_level": 24}


def test_progress_is_shown_and_stops(room):
    seen = []

    def progress(now):
        seen.append((now.phase, now.links))
        return len(seen) < 3

    with pytest.raises(hr2d.Stopped):
        room.solve(**ENDLESS, max_bytes=10**9, progress=progress)
    assert len(seen) == 3 and seen[-1][0] == "refine" and seen[-1][1] > seen[0][1]


# Many digits of a scene with many patches take minutes.
TARGETS = [{"error": 1e-12}, {"seconds": 600}, {"error": 1e-12, "seconds": 600}]


@pytest.fixture
def street():
    scene = hr2d.Scene()
    for x in range(2000):
        scene.add([(x, 0), (x + .3, 1 + x % 3)], emission=1, reflectance=.5, sides="both")
    return scene


@pytest.mark.parametrize("target", TARGETS)
def test_a_solve_to_a_target_asks_and_stops(street, target):
    phases = []

    def progress(now):
        phases.append(now.phase)
        return len(phases) < 3

    with pytest.raises(hr2d.Stopped):
        street.solve(**target, progress=progress)
    assert len(phases) == 3


@pytest.mark.parametrize("target", TARGETS)
def test_ctrl_c_ends_a_solve_to_a_target(street, target):
    old = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            street.solve(**target)
    finally:
        signal.signal(signal.SIGINT, old)


def test_ctrl_c_ends_a_call(room, monkeypatch):
    old = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(.2, os.kill, (os.getpid(), signal.SIGINT)).start()
        start = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            room.solve(**ENDLESS, max_bytes=10**9)
        assert time.monotonic() - start < 5
    finally:
        signal.signal(signal.SIGINT, old)
    assert room.solve().account.reached


def test_other_threads_run_during_a_call(room):
    """Between two questions of the library, 50 ms apart, another thread takes many turns."""
    ticks, polls, end = [], [], threading.Event()

    def tick():
        while not end.wait(.001):
            ticks.append(None)

    def progress(now):
        polls.append(len(ticks))
        return len(polls) < 8

    other = threading.Thread(target=tick)
    other.start()
    try:
        with pytest.raises(hr2d.Stopped):
            room.solve(**ENDLESS, max_bytes=10**9, progress=progress)
    finally:
        end.set()
        other.join()
    assert polls[-1] - polls[0] > 3 * len(polls)


def test_a_scene_is_not_changed_from_within(room):
    def progress(now):
        room.factors()
        return False

    with pytest.raises(hr2d.Stopped):
        room.solve(**ENDLESS, max_bytes=10**9, progress=progress)
