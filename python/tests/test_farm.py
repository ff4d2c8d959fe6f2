"""Sweeps on several machines: Ray as three nodes on one."""

import subprocess
import sys

import pytest
from tqdm import tqdm

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


def test_what_is_lost_in_between_is_done_again_and_the_table_is_the_serial_one(cluster, tmp_path, monkeypatch):
    source = tmp_path / "farmed.arl"
    source.write_text(PROGRAM)
    rows = [{"global.angle": 1 + at / 10_000} for at in range(10_000)]
    rows[4_000] = {"global.hangs": True}
    rows[5_000] = {"global.parts": 0}
    rows[6_000] = {"global.none": 0}
    nodes = [cluster.add_node(num_cpus=1) for _ in range(2)]
    arguments = {"max_time": 1e9, "timeout": 3.0, "cache": False}
    serial = arl2rs.sweep(source, rows, processes=1, **arguments)

    killed = []

    class Killer(tqdm):
        """Kills a node once a third is done."""

        def update(self, n=1):
            super().update(n)
            if self.n > 3_000 and not killed:
                killed.append(self.n)
                cluster.remove_node(nodes[0], allow_graceful=False)

    monkeypatch.setattr("arl2rs.sweeps.tqdm", Killer)
    farmed = arl2rs.sweep(source, rows, engine="ray", progress=True, **arguments)
    assert killed and killed[0] < 9_000
    assert farmed.lines == serial.lines
    assert [farmed[at]["outcome"] for at in (0, 4_000, 5_000, 6_000)] == ["ended", "hung", "alarm", "refused"]
    assert len({row["run"] for row in farmed}) == 10_000


def test_what_is_known_is_not_done_again(cluster, tmp_path, monkeypatch):
    source = tmp_path / "known.arl"
    source.write_text(PROGRAM)
    rows = [{"global.angle": 1.5}, {"global.angle": 2}]
    farmed = arl2rs.sweep(source, rows, engine="ray", clearance=2000)
    monkeypatch.setattr("arl2rs.farm._make_all", None)
    assert arl2rs.sweep(source, rows, engine="ray", clearance=2000).lines == farmed.lines
    monkeypatch.undo()
    assert arl2rs.sweep(source, rows, cache=False, clearance=2000).lines == farmed.lines


def test_who_stops_leaves_nothing_on_the_cluster(cluster, tmp_path, monkeypatch):
    source = tmp_path / "stopped.arl"
    source.write_text(PROGRAM)

    class Stopped(Exception):
        pass

    class Stopper(tqdm):
        def update(self, n=1):
            raise Stopped

    monkeypatch.setattr("arl2rs.sweeps.tqdm", Stopper)
    with pytest.raises(Stopped):
        arl2rs.sweep(source, [{"global.hangs": True}] * 2, engine="ray", max_time=1e9, timeout=1e6, cache=False)
    monkeypatch.undo()
    # The cores are free again.
    assert arl2rs.sweep(source, [{}], engine="ray", cache=False)[0]["outcome"] == "ended"


def test_nodes_with_another_version_are_reported(cluster, tmp_path, monkeypatch):
    source = tmp_path / "other.arl"
    source.write_text(PROGRAM)
    monkeypatch.setattr("arl2rs._arl2rs.VERSION", "0.0.1")
    with pytest.raises(arl2rs.ArlError, match=r"a node does not have this arl2rs: .*the sweep 0\.0\.1"):
        arl2rs.sweep(source, [{}], engine="ray", cache=False)


def test_nodes_without_the_package_are_reported(tmp_path):
    """The only node has another package of that name."""
    other = tmp_path / "other/arl2rs"
    other.mkdir(parents=True)
    (other / "__init__.py").write_text("from . import nothing\n")
    source = tmp_path / "bare.arl"
    source.write_text(PROGRAM)
    script = f"""\
import arl2rs, ray
ray.init(address="local", num_cpus=1, log_to_driver=False, runtime_env={{"env_vars": {{"PYTHONPATH": {str(other.parent)!r}}}}})
try:
    arl2rs.sweep({str(source)!r}, [{{}}], engine="ray", cache=False)
except arl2rs.ArlError as problem:
    print(problem)
"""
    shown = subprocess.run(
        [sys.executable, "-P", "-c", script], cwd=tmp_path, check=True, capture_output=True, text=True
    ).stdout
    assert shown.startswith("a node does not have this arl2rs: install the same version on all nodes of the cluster (")
