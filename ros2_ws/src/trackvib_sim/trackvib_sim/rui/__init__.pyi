# a tree, its state and its accelerations
from .table import Body as Body
from .table import Hinge as Hinge
from .table import check_table as check_table
from .state import Accelerations as Accelerations
from .state import Loads as Loads
from .state import TreeState as TreeState
from .state import no_loads as no_loads
from .state import rest_state as rest_state
from .solve import accelerations as accelerations

# the same by the overall transfer equation
from .reference.form_a import form_a as form_a
from .reference.form_x import form_x as form_x

# loops
from .closed_chain import closed_accelerations as closed_accelerations
from .cut_pin import CutPin as CutPin

# small motions
from .linear.equilibrium import find_equilibrium as find_equilibrium
from .linear.frequency_response import At as At
from .linear.frequency_response import frequency_response as frequency_response
from .linear.model import GroundSpring as GroundSpring
from .linear.model import LinearModel as LinearModel
from .linear.mode import Mode as Mode
from .linear.modes import modes as modes
from .linear.modes import natural_frequencies as natural_frequencies
