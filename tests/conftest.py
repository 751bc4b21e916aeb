"""What the system tests share: real processes in a ROS domain of their own."""

import fcntl
import os
import tempfile
import time
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest
import rclpy
from ament_index_python.packages import get_package_prefix
from diagnostic_msgs.msg import DiagnosticArray
from mr_mount_controller.node_base.shared_memory import remove_unfinished_segments
from mr_mount_controller.node_base.taken_up import taken_up
from rclpy.experimental import EventsExecutor
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from .bag_helpers import edit_bag
from .kept_cases import KeptCases
from .processes import PATIENCE, Process, Program, processes_printing_to, trackvib

PACKAGES = {
    "simulator": "trackvib_sim",
    "road_excitation": "trackvib_sim",
    "recorder": "trackvib_sim",
    "player": "trackvib_sim",
    "one_process": "trackvib_sim",
    "controller": "mr_mount_controller",
}
# s, an `answer_timeout` that a busy machine does not use up: for runs in which silence would be an error.
UNHURRIED = 20.0
DOMAINS = range(40, 100)
FIRST = ("test_tutorials.py", "test_studies.py")  # leave cases of studies that the documents' commands need not drive


def pytest_collection_modifyitems(items):
    """Begin with what others can use; everything else stays in its order."""
    items.sort(key=lambda item: item.path.name not in FIRST)


def wait_until(condition, seconds=PATIENCE, what="what is waited for"):
    """Wait until `condition()`, so many seconds at most."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"{what} never came within {seconds:g} s"
        time.sleep(0.05)


@contextmanager
def free_domain():
    """Give a ROS domain that no other test on this machine uses at the time, held by a lock on a file."""
    for number in DOMAINS:
        with (Path(tempfile.gettempdir()) / f"trackvib_test_domain_{number}").open("w") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            yield number
            return
    raise RuntimeError("every ROS domain for tests is in use")


@pytest.fixture(scope="module")
def domain():
    """A ROS domain of a test file's own."""
    with free_domain() as number:
        yield number


@pytest.fixture(scope="session")
def shared_folder(tmp_path_factory):
    """A folder of the test run, the same one for all its workers."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def kept_cases(shared_folder):
    """Finished cases of studies, see `KeptCases`."""
    return KeptCases(shared_folder / "kept_cases")


@pytest.fixture(scope="session")
def recorded_run(shared_folder):
    """The folder of one `trackvib run` under skyhook, shared by all tests that only read it, on all cores."""
    folder = shared_folder / "recorded_run"
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            _record_run(folder)
    return folder


def _record_run(folder):
    made = folder.with_suffix(".new")
    with free_domain() as number:
        env = {**os.environ, "ROS_DOMAIN_ID": str(number)}
        trackvib("run", "--law", "skyhook", "--duration", "3.2", "--out", made, env=env)
    made.rename(folder)


@pytest.fixture
def edited(recorded_run, tmp_path):
    """Copy the recorded bag with other messages or provenance: `edited(message, provenance)`, see `edit_bag`."""
    return partial(edit_bag, recorded_run / "bag", tmp_path / "edited")


@pytest.fixture
def env(domain):
    """The environment of the test's processes."""
    return {**os.environ, "ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1"}


@pytest.fixture
def user_module(tmp_path, env):
    """Write a module of a user's own on the Python path of the test's processes: `user_module(name, text)`."""

    def write(name, text):
        (tmp_path / f"{name}.py").write_text(text)

    env["PYTHONPATH"] = os.pathsep.join([str(tmp_path), env.get("PYTHONPATH", "")])
    return write


@pytest.fixture
def processes(tmp_path):
    """The processes of a test, which end with it, and with them what they have started."""
    started = []
    yield started
    for process in started:
        process.clean_up()
    # nodes end a moment after their killed parent, and the next test may use their ROS domain
    wait_until(lambda: not processes_printing_to(tmp_path), what="the end of all nodes")


@pytest.fixture
def start(processes, tmp_path, env):
    """Start processes that end with the test: `start(command)`."""

    def make(command):
        log = tmp_path / f"process_{len(processes)}.log"
        processes.append(Process([str(word) for word in command], log, env, tmp_path))
        return processes[-1]

    return make


@pytest.fixture
def fork(processes, tmp_path, env):
    """Start programs of ours that end with the test: `fork(name, arguments)`."""

    def make(name, arguments):
        log = tmp_path / f"process_{len(processes)}.log"
        processes.append(Program(name, [str(word) for word in arguments], log, env, tmp_path))
        return processes[-1]

    return make


@pytest.fixture
def start_node(start, fork):
    """Start one of the nodes by its installed entry point: `start_node("simulator", speed=5.0)`.

    `before` are words of a command that runs its executable.
    """

    def make(name, *arguments, before=(), **parameters):
        words = [*map(str, arguments), "--ros-args"]
        for parameter, value in parameters.items():
            words += ["-p", f"{parameter}:={str(value).lower() if isinstance(value, bool) else value}"]
        if before:
            return start([*before, f"{get_package_prefix(PACKAGES[name])}/lib/{PACKAGES[name]}/{name}", *words])
        return fork(name, words)

    return make


class Observer:
    """A node in the test's own process: follows the simulator's diagnostics, calls its services."""

    def __init__(self, domain):
        remove_unfinished_segments()
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        self._node = rclpy.create_node("observer", context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._node.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 1000)
        self.told = []  # all diagnostics, as text
        self._clients = {}

    @property
    def node(self):
        """Its node, for further topics."""
        return self._node

    def _on_diagnostics(self, message):
        self.told.append({pair.key: pair.value for pair in message.status[0].values})

    @property
    def values(self):
        """The latest diagnostics, as text."""
        return self.told[-1] if self.told else {}

    def wait_until(self, condition):
        """Wait until `condition()`."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, f"never came; the simulator last told {self.values}"
            self._executor.spin_once(timeout_sec=0.1)

    def wait_for(self, **values):
        """Wait until the simulator tells values, given as text; returns its simulated time [s]."""
        self.wait_until(lambda: values.items() <= self.values.items())
        return float(self.values["time"])

    def wait_for_service(self, ready):
        """Wait until a client just made may ask: it is taken up here, and `ready()` says that the service is there."""
        self.wait_until(taken_up(self._node))
        self.wait_until(ready)

    def client(self, name, node="simulator"):
        """Return a client of a service that is there; asked for beforehand, a later call takes no time to find it."""
        if (node, name) not in self._clients:
            self._clients[node, name] = self._node.create_client(Trigger, f"{node}/{name}")
        self.wait_for_service(self._clients[node, name].service_is_ready)
        return self._clients[node, name]

    def call(self, name, node="simulator"):
        """Call a service of the simulator, or of another node; returns its response."""
        future = self.client(name, node).call_async(Trigger.Request())
        self.wait_until(future.done)
        return future.result()

    def collect(self, message_type, topic, qos):
        """Subscribe to a topic; returns the list to which its serialised messages go."""
        messages = []
        self._node.create_subscription(message_type, topic, lambda data: messages.append(bytes(data)), qos, raw=True)
        return messages

    def clean_up(self):
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)


@pytest.fixture
def observer(domain):
    """An `Observer` in the domain of the test's processes."""
    one = Observer(domain)
    yield one
    one.clean_up()


@pytest.fixture
def start_cli(fork):
    """Start the command line: `start_cli("run", "--speed", 5)`."""
    return lambda *arguments: fork("trackvib", arguments)
