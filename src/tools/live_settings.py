"""What an observer's configuration says of its units, sensors and position, for the tools that show it live: read from the
parameter server, where observer.launch puts the files as text."""
import math

import rospy
import yaml


def merged(tree, other):
    for key, value in other.items():
        tree[key] = merged(tree[key], value) if isinstance(value, dict) and isinstance(tree.get(key), dict) else value
    return tree


def configuration(observer):
    """The configuration of a node; empty where its launch file did not give it as text."""
    tree = {}
    files = rospy.get_param(observer + "/config", {})
    for file in files.values() if isinstance(files, dict) else []:
        if isinstance(file, dict) and "text" in file:
            merged(tree, yaml.safe_load(file["text"]) or {})
    return tree


def measured_states(plant, sensor):
    """Which state each output of a sensor is, by its name; None for an output that is none."""
    names = plant.get("states", [])
    if "h" in sensor:
        outputs = [str(formula).strip() if str(formula).strip() in names else None for formula in sensor["h"]]
    elif "C" in sensor and "d" not in sensor:
        units = [[float(k == i) for k in range(len(names))] for i in range(len(names))]
        outputs = [names[units.index(row)] if row in units else None for row in ([float(x) for x in row] for row in sensor["C"])]
    else:
        outputs = []
    biases = sensor.get("bias") or [""] * len(outputs)
    return [None if bias else state for state, bias in zip(outputs, biases)]


def settings(observer):
    """{units: {name: unit}, sensors: {name: {states, T1, T2}}, position: [x, y, z], yaw}: times in seconds, None where
    there is none; entries of the position are names of states, numbers, or None."""
    try:
        tree = configuration(observer)
        plant = tree.get("plant", {})
        common = tree.get("sampling", {})
        sensors = {}
        for name, sensor in (tree.get("sensors") or {}).items():
            times = sensor.get("sampling") or common.get(name) or common
            T1, T2 = (float(times.get(key, math.inf)) for key in ("T1", "T2"))
            sensors[name] = {"states": measured_states(plant, sensor), "T1": T1 if math.isfinite(T1) else None,
                             "T2": T2 if math.isfinite(T2) else None}
        outputs = tree.get("outputs", {})
        position = outputs.get("position", {})
        return {"units": plant.get("units", {}), "sensors": sensors, "position": [position.get(axis) for axis in "xyz"],
                "yaw": outputs.get("orientation", {}).get("yaw")}
    except (AttributeError, KeyError, TypeError, ValueError, yaml.YAMLError) as fault:
        rospy.logwarn("the configuration of %s can't be read: %s", observer, fault)
        return {"units": {}, "sensors": {}, "position": [None] * 3, "yaw": None}
