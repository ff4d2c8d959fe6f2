"""Sweeps on several machines: Ray as three nodes on one."""

import threading
import time

import pytest

import arl2rs

ray = pytest.importorskip("ray")

PROGRAM = """\
double angle = 1
int parts = 4
bool hangs = false

func void main()
    joint start = cjoint()
    start.j1 = start.j1 + angle
    movej start, vp:100%
    while(hangs)
    endwhile
    print 12 / parts
endfunc
"""


@pytest.fixture(scope="module")
def cluster():
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
    ray.init(address=cluster.address, log_to_driver=False)
    yield cluster
    ray.shutdown()
    cluster.shutdown()


def test_what_is_lost_in_between_is_done_again_and_the_table_is_the_serial_one(cluster, tmp_path):
    source = tmp_path / "farmed.arl"
    source.write_text(PROGRAM)
    rows = [{"global.angle": 1 + at / 10_000} for at in range(10_000)]
    rows[4_000] = {"global.hangs": True}
    rows[5_000] = {"global.parts": 0}
    rows[6_000] = {"global.none": 0}
    nodes = [cluster.add_node(num_cpus=1) for _ in range(2)]
    arguments = {"max_time": 1e9, "timeout": 3.0, "cache": False}
    serial = arl2rs.sweep(source, rows, processes=1, **arguments)

    def kill():
        time.sleep(6.0)
        cluster.remove_node(nodes[0], allow_graceful=False)

    threading.Thread(target=kill).start()
    farmed = arl2rs.sweep(source, rows, engine="ray", **arguments)
    assert farmed.lines == serial.lines
    assert [farmed[at]["outcome"] for at in (0, 4_000, 5_000, 6_000)] == ["ended", "hung", "alarm", "refused"]
    assert len({row["run"] for row in farmed}) == 10_000


def test_what_is_known_is_not_done_again(cluster, tmp_path):
    source = tmp_path / "known.arl"
    source.write_text(PROGRAM)
    rows = [{"global.angle": 1.5}, {"global.angle": 2}]
    farmed = arl2rs.sweep(source, rows, engine="ray")
    ray.shutdown()
    try:
        # Nobody is there to make runs, and nobody is needed.
        from arl2rs import farm

        assert arl2rs.sweep(source, rows).lines == farmed.lines
        assert farm is not None
    finally:
        ray.init(address=cluster.address, log_to_driver=False)
