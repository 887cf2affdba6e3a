"""Gain files, and other configurations, as trees of NumPy arrays."""
import numpy
import yaml


def read_gains(path):
    """The tree of a gain file: its maps as dictionaries, numbers as floats, lists of numbers and matrices as arrays.

    `read_gains('cart_gains.yaml')['gains']['L']` is an n x m array. Keys are texts, also those of modes and nodes, and
    formulas stay texts. Raises ValueError where the file has no key `gains`.
    """
    with open(path, encoding='utf-8') as file:
        tree = yaml.load(file, Loader=yaml.BaseLoader)  # texts only: YAML 1.1 takes 1e-3 for one, and `on` for true
    if not isinstance(tree, dict) or 'gains' not in tree:
        raise ValueError(f'{path}: expected the key gains at the top of a gain file, found '
                         f'{", ".join(tree) if isinstance(tree, dict) else "no map"}')
    return _converted(tree)


def _converted(node):
    if isinstance(node, dict):
        if list(node) == ['diagonal']:
            return numpy.diag(_converted(node['diagonal']))
        return {str(key): _converted(value) for key, value in node.items()}
    if isinstance(node, list):
        values = [_converted(value) for value in node]
        try:
            return numpy.array(values, dtype=float)
        except (TypeError, ValueError):
            return values
    return {'true': True, 'false': False}.get(node, _number(node))


def _number(text):
    try:
        return float({'.inf': 'inf', '-.inf': '-inf'}.get(text, text))
    except (TypeError, ValueError):
        return text
