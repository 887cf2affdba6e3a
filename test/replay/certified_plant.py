"""A plant with its scenario, observer and certificate, whose plant's hash is still HASH."""

# The error falls as exp(-t), whatever is measured.
CERTIFIED = """
observer: ConstantGainObserver
plant: {states: [x], A: [[-1]]}
sensors: {position: {C: [[1]], source: {topic: position}}}
sampling: {T1: 0.1, T2: 0.1}
gains: {L: [[0]]}
certificate:
  theorem: ferrante2016_theorem1
  plant: {file: plant.yaml, hash: HASH}
  T1: 0.1
  T2: 0.1
  decay: 0.5
  P: [[1]]
scenario:
  duration: 3
  initial_state: {x: 1}
  sensors: {position: {schedule: {period: 0.1}}}
"""
