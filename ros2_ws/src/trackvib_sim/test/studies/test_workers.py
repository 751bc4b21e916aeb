"""Strangers at the cluster that a study starts for itself: real connections to all that listens there."""

import asyncio
import ssl
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import urlopen

import psutil
import pytest
from distributed import Client, Security, rpc
from distributed.comm import parse_host_port
from distributed.protocol.pickle import dumps
from trackvib_sim.studies.workers import workers

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="starts worker processes")]

PATIENCE = 3.0  # s until a stranger gives up
CREDENTIALS = ("tls_ca_file", "tls_client_cert", "tls_client_key")


def listening():
    """Return the addresses at which this process and its children listen."""
    me = psutil.Process()
    return {
        connection.laddr
        for process in (me, *me.children(recursive=True))
        for connection in process.net_connections("inet")
        if connection.status == psutil.CONN_LISTEN
    }


@pytest.fixture(scope="module")
def others():
    """Where the tests' process listens before there is a cluster: its plug-ins may."""
    return listening()


@pytest.fixture(scope="module")
def client(others):
    """The `Client` of a study's own cluster of one worker."""
    with workers(None, 1) as client:
        yield client


@pytest.fixture(scope="module")
def servers(client):
    """Address of scheduler, nanny and worker, and how each is told to run a function."""
    ((worker, told),) = client.scheduler_info()["workers"].items()
    return {client.scheduler.address: "run_function", told["nanny"]: "run", worker: "run"}


def stranger(kind, address):
    """Return the address and the credentials that somebody else of this machine has."""
    if kind == "without credentials":
        return address.replace("tls://", "tcp://"), Security()
    made = Security.temporary()
    others = {name: getattr(made, name) for name in CREDENTIALS}
    if kind == "who trusts the cluster":
        others["tls_ca_file"] = ssl.get_server_certificate(parse_host_port(address.removeprefix("tls://")))
    return address, Security(require_encryption=True, **others)


def run_at(address, security, verb, function, *arguments):
    """Have a server run a function, without a `Client`."""

    async def ask():
        async with rpc(address, connection_args=security.get_connection_args("client"), timeout=PATIENCE) as server:
            return await getattr(server, verb)(function=dumps(function), args=dumps(arguments), kwargs=None)

    return asyncio.run(ask())


KINDS = pytest.mark.parametrize(
    "kind", ["without credentials", "with credentials of another cluster", "who trusts the cluster"]
)


@KINDS
def test_a_strangers_client_is_refused(client, kind, tmp_path):
    """It does not get as far as sending anything."""
    address, security = stranger(kind, client.scheduler.address)
    with pytest.raises(OSError), Client(address, security=security, timeout=PATIENCE) as other:
        other.submit(Path.touch, tmp_path / "theirs").result(PATIENCE)
    assert not (tmp_path / "theirs").exists()
    client.submit(Path.touch, tmp_path / "ours").result()
    assert (tmp_path / "ours").exists()


@KINDS
def test_no_server_runs_a_strangers_code(client, servers, kind, tmp_path):
    """Scheduler, nanny and worker run what the study's own credentials come with, and nothing else."""
    for number, (server, verb) in enumerate(servers.items()):
        address, security = stranger(kind, server)
        with pytest.raises(OSError):
            run_at(address, security, verb, Path.touch, tmp_path / f"theirs {number}")
        run_at(server, client.security, verb, Path.touch, tmp_path / f"ours {number}")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["ours 0", "ours 1", "ours 2"]


def test_what_listens_tells_nothing(others, servers):
    """Every port of the cluster's processes is on this machine alone, and is TLS or an HTTP server without pages."""
    places = listening() - others
    assert all(place.ip == "127.0.0.1" for place in places)
    pages = {f"{place.ip}:{place.port}" for place in places} - {server.removeprefix("tls://") for server in servers}
    assert pages
    for place in pages:
        for page in ("", "health", "info/main/workers.html", "json/identity.json", "metrics"):
            with pytest.raises(HTTPError, match="404"):
                urlopen(f"http://{place}/{page}", timeout=PATIENCE)


def test_credentials_are_on_no_command_line(client):
    """Nor in the environment of a worker's process."""
    key = client.security.tls_worker_key.splitlines()[1]
    children = psutil.Process().children(recursive=True)
    assert children
    for process in children:
        assert key not in " ".join(process.cmdline()) and key not in str(process.environ())
