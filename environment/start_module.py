"""Run a module as `python -m` does, without its search in the folder where the user stands.

    python start_module.py MODULE [ARGUMENTS]

A file there that is called json.py or click.py would be run in place of the library's. Python 3.11 has the option -P
for this; 3.10 has not, and its variable PYTHONSAFEPATH would reach the user's own programs, too.
"""

import sys

if not getattr(sys.flags, "safe_path", False):
    del sys.path[0]  # the folder of this file, put there by Python; so the next import is safe already

import runpy

del sys.argv[0]
runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
