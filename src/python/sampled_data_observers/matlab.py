"""Export for MATLAB and Octave."""
import re

import numpy


def save_mat(path, **variables):
    """Writes a .mat file (version 5) with one variable for each keyword, such as `estimates=`, `gains=`.

    Estimates and events become structs of arrays, trees of read_gains() structs of structs. Names that MATLAB does not
    allow are changed: `camera/left` to camera_left, `0` to x0. Takes scipy (Debian: python3-scipy). Raises ValueError
    where two names then are one.
    """
    try:
        from scipy.io import savemat
    except ImportError as fault:
        raise ImportError('save_mat takes scipy: install python3-scipy') from fault
    savemat(str(path), _struct(variables), oned_as='column', long_field_names=True)


def _struct(value):
    if isinstance(value, dict):
        struct = {}
        for key, part in value.items():
            name = _name(key)
            if name in struct:
                raise ValueError(f'two names of one map are {name} in MATLAB, one of them is {key}')
            struct[name] = _struct(part)
        return struct
    if hasattr(value, 'stamps'):
        return _struct({key: part for key, part in vars(value).items() if part is not None})
    if isinstance(value, numpy.ndarray) and value.dtype.kind == 'U':
        return value.astype(object)
    if isinstance(value, (list, tuple)):
        cells = numpy.empty(len(value), dtype=object)
        cells[:] = [_struct(part) for part in value]
        return cells
    return value


def _name(key):
    name = re.sub(r'\W', '_', key, flags=re.ASCII)
    return (name if re.match('[A-Za-z]', name) else 'x' + name)[:63]
