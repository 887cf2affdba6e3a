"""A gain file and the plant that it names, read without the package."""

import os
from dataclasses import dataclass, field

import yaml
from mpmath import mpf

from high_precision import identity, matrix, stacked, zeros


class Unreadable(Exception):
    """What this reader does not know, or what no claim may say."""


def number(value):
    """PyYAML takes `1e-05` for text. What counts is the double, with which an observer computes."""
    if isinstance(value, bool):
        raise Unreadable(f"a number was expected, found {value}")
    try:
        return mpf(float(value))
    except (TypeError, ValueError) as error:
        raise Unreadable(f"a number was expected, found {value!r}") from error


def numbers(rows):
    return matrix([[number(value) for value in row] for row in rows])


@dataclass
class Mode:
    label: int
    A: list
    A_d: list = None


@dataclass
class Claim:
    theorem: str
    observer: str
    T1: object
    T2: object
    states: int
    modes: list
    C: list = field(default_factory=list)
    sampled: list = field(default_factory=list)  # of each sampled sensor its name and its C
    C_c: list = field(default_factory=list)
    C_d: list = field(default_factory=list)
    G: list = None
    S: list = None
    psi: list = None
    lipschitz: object = None
    jump_lipschitz: object = None
    vertices: list = field(default_factory=list)
    flows: list = field(default_factory=list)  # A is anything in their hull
    N: list = None
    C_p: list = None
    gains: dict = field(default_factory=dict)
    values: dict = field(default_factory=dict)

    @property
    def has_dwell_time(self):
        return any(key in self.values
                   for key in ("average_dwell_time", "reverse_average_dwell_time"))

    @property
    def A(self):
        return self.modes[0].A

    @property
    def A_d(self):
        return self.modes[0].A_d

    def value(self, name):
        """A number or a matrix of the certificate or of the gains; `P/1` stands below two keys."""
        for source in (self.values, self.gains):
            found = source
            for key in name.split("/"):
                if not isinstance(found, dict):
                    found = None
                    break
                found = found.get(key, found.get(int(key)) if key.isdigit() else None)
                if found is None:
                    break
            if found is not None:
                return numbers(found) if isinstance(found, list) else number(found)
        raise Unreadable(f"the gain file does not say {name}")


def with_biases(rows, biases, own, total):
    """The outputs' matrix, with ones where a sensor's biases, which are states, enter."""
    result = [list(row) + [mpf(0)] * (total - len(row)) for row in rows]
    for row, bias in zip(result, biases):
        row[own + bias] = mpf(1)
    return result


def extended(rows, total):
    """A square matrix, with states that stay as they are."""
    n = len(rows)
    if n == total:
        return rows
    return stacked([[rows, zeros(n, total - n)], [zeros(total - n, total)]])


def extended_by_identity(rows, total):
    n = len(rows)
    if n == total:
        return rows
    return stacked([[rows, zeros(n, total - n)],
                    [zeros(total - n, n), identity(total - n)]])


def read_claims(path, plant_path=None):
    """The claims that a gain file makes of its gains."""
    with open(path, encoding="utf-8") as stream:
        gain_file = yaml.safe_load(stream)
    if not isinstance(gain_file.get("certificate"), dict):
        raise Unreadable(f"{path} has no certificate")
    return [read_claim(path, gain_file, gain_file[section], plant_path)
            for section in ("certificate", "run_time_certificate") if section in gain_file]


def read_claim(path, gain_file, certificate, plant_path):
    if plant_path is None:
        plant_path = os.path.join(os.path.dirname(path), certificate["plant"]["file"])
    with open(plant_path, encoding="utf-8") as stream:
        document = yaml.safe_load(stream)
    plant = document["plant"]

    by_timing = {"sampled": [], "continuous": [], "at_jumps": []}
    names = []
    for name, sensor in sorted(document.get("sensors", {}).items()):
        timing = sensor.get("measured", "sampled")
        by_timing[timing].append((name, sensor))
        names += [bias for bias in sensor.get("bias", []) if bias not in names]
    own = len(plant["states"])
    total = own + len(names)
    is_of_several = certificate["theorem"].startswith("timer_dependent")

    def output_of(sensor):
        if "C" not in sensor:
            return []
        biases = [names.index(bias) for bias in sensor.get("bias", [])]
        return with_biases(numbers(sensor["C"]), biases, own, total)

    def output(timing):
        sensors = [sensor for _, sensor in by_timing[timing]]
        if not sensors:
            return []
        if len(sensors) > 1 and not (timing == "sampled" and is_of_several):
            raise Unreadable(f"several sensors that are {timing}")
        return [row for sensor in sensors for row in output_of(sensor)]

    def jump_map(section):
        if section is None:
            return None
        return extended_by_identity(numbers(section["A_d"]), total) if "A_d" in section else None

    stated_A = certificate.get("A")
    modes, flows = [], []
    if "modes" in plant:
        for label, mode in sorted(plant["modes"].items()):
            modes.append(Mode(int(label), extended(numbers(mode["A"]), total),
                              jump_map(mode.get("jump_map", plant.get("jump_map")))))
    elif "A" in plant:
        if stated_A is not None and numbers(stated_A) != extended(numbers(plant["A"]), total):
            raise Unreadable("certificate/A takes the place of the plant's own")
        modes.append(Mode(0, extended(numbers(plant["A"]), total), jump_map(plant.get("jump_map"))))
    elif stated_A is None and "jacobian_vertices" in plant and total == own:
        flows = [numbers(rows) for _, rows in sorted(plant["jacobian_vertices"].items())]
        modes.append(Mode(0, flows[0], jump_map(plant.get("jump_map"))))
    elif stated_A is not None:
        modes.append(Mode(0, numbers(stated_A), jump_map(plant.get("jump_map"))))
    else:
        raise Unreadable("the plant's flow is not given by matrices")
    if certificate.get("A_d") is not None:
        modes[0].A_d = numbers(certificate["A_d"])

    intervals = list(certificate.get("sensors", {}).values())
    if "T2" in certificate:
        intervals.append(certificate)
    claim = Claim(
        theorem=certificate["theorem"],
        observer=gain_file["observer"],
        T1=min((number(interval["T1"]) for interval in intervals), default=mpf(0)),
        T2=max((number(interval["T2"]) for interval in intervals), default=mpf("inf")),
        states=total,
        modes=modes,
        flows=flows,
        C=output("sampled"),
        sampled=[(name, output_of(sensor)) for name, sensor in by_timing["sampled"]],
        C_c=output("continuous"),
        C_d=output("at_jumps"),
        gains=gain_file["gains"],
        values=certificate,
    )
    if plant.get("G") is not None:
        claim.G = numbers(plant["G"]) + zeros(total - own, len(plant["G"][0]))
        claim.S = [row + [mpf(0)] * (total - own) for row in numbers(plant["S"])]
        claim.psi = plant.get("psi")
        claim.lipschitz = plant.get("lipschitz_constant")
        claim.vertices = [extended(numbers(rows), total)
                          for _, rows in sorted(plant.get("vertices", {}).items())]
    if "lipschitz_constant" in (plant.get("jump_map") or {}):
        claim.jump_lipschitz = number(plant["jump_map"]["lipschitz_constant"])
    if certificate.get("N") is not None:
        claim.N = numbers(certificate["N"])
    if certificate.get("C_p") is not None:
        claim.C_p = numbers(certificate["C_p"])
    return claim
