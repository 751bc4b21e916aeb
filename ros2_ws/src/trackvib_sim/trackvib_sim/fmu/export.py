"""Packs a vehicle on its road as an FMU, which runs in processes of this Python with the packages of this one."""

import hashlib
import json
import os
import sys
import sysconfig
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from xml.etree import ElementTree

import mr_mount_controller
from pythonfmu import FmuBuilder

# The module in the FMU. Its name tells vehicle, road and so on apart, for several FMUs may run in one process.
_MODULE = '''\
"""Finds the packages that the FMU was made with, and the vehicle that it stands for."""

import json
import os
import sys
from pathlib import Path

told = json.loads(Path(__file__).with_name("told.json").read_text(encoding="utf-8"))
if list(sys.version_info[:2]) != told["python"]:
    raise ImportError("this FMU needs Python {}.{}, this is {}.{}".format(*told["python"], *sys.version_info))
sys.path += [folder for folder in told["packages"] if folder not in sys.path]
os.environ.setdefault("NUMBA_CACHE_DIR", told["kernels"])

from trackvib_sim.fmu.slave import VehicleSlave


class trackvib(VehicleSlave):
    pass


trackvib.told = told
# with each instance PythonFMU's loader runs this once more, and gives up a reference to globals that it does not own
VehicleSlave.kept.append(globals())
'''


class Exported(NamedTuple):
    """What an FMU has."""

    inputs: int
    outputs: int
    period: float  # s


def export(file, **told):
    """Write the FMU to a new file ending in .fmu; returns what it has (`Exported`).

    `told` is what `slave.VehicleSlave.told` must hold. Raises as that class does, and `OSError`.
    """
    told |= {"python": sys.version_info[:2], "packages": packages(), "kernels": os.environ.get("NUMBA_CACHE_DIR", "")}
    text = json.dumps(told)
    with TemporaryDirectory() as folder:
        module = Path(folder, f"trackvib_{hashlib.sha256(text.encode()).hexdigest()[:12]}.py")
        module.write_text(_MODULE, encoding="utf-8")
        settings = Path(folder, "told.json")
        settings.write_text(text, encoding="utf-8")
        FmuBuilder.build_FMU(module, file, [settings])
    with zipfile.ZipFile(file) as made:
        description = ElementTree.fromstring(made.read("modelDescription.xml"))
    kinds = [variable.get("causality") for variable in description.iter("ScalarVariable")]
    step = float(description.find("DefaultExperiment").get("stepSize"))
    return Exported(kinds.count("input"), kinds.count("output"), step)


def packages():
    """Folders in which this process finds both packages and what they need."""
    ours = (Path(__file__).parents[2], Path(mr_mount_controller.__file__).parents[1])
    theirs = (sysconfig.get_path(name) for name in ("purelib", "platlib"))
    return list(dict.fromkeys(map(str, (*ours, *theirs))))
