"""Estimates, truths and events of bags: recorded live, or written by `replay -o` and `simulate -o`."""
import numpy
import rosbag

from sampled_data_observers.msg import EventStatus


class Estimates:
    """The messages StateEstimate of one topic, in the order of their stamps.

    names         names of the n states, biases last
    stamps        N stamps [s]
    states        N x n
    covariances   N x n x n; None where the observer has none
    error_bound   N: the guaranteed bound on the norm of the error; NaN without, infinite where nothing is known
    error_bounds  N x n: those on each state, likewise
    events, samples, jumps  N: how many each rests on
    held          N: whether the last finite state was held
    """

    def __init__(self, messages):
        first = messages[0]
        if any(message.names != first.names for message in messages):
            raise ValueError('expected estimates of the same states throughout, found others from some stamp on')
        messages = sorted(messages, key=lambda message: message.header.stamp)
        self.names = list(first.names)
        n = len(self.names)
        self.stamps = numpy.array([message.header.stamp.to_sec() for message in messages])
        self.states = numpy.array([message.state for message in messages]).reshape(len(messages), n)
        self.covariances = None
        if all(len(message.covariance) == n * n for message in messages):
            self.covariances = numpy.array([message.covariance for message in messages]).reshape(-1, n, n)
        self.error_bound = numpy.array([message.error_bound for message in messages])
        self.error_bounds = numpy.array(
            [message.error_bounds if len(message.error_bounds) == n else [numpy.nan] * n for message in messages])
        self.events = numpy.array([message.events for message in messages])
        self.samples = numpy.array([message.samples for message in messages])
        self.jumps = numpy.array([message.jumps for message in messages])
        self.held = numpy.array([message.held for message in messages])

    def __len__(self):
        return len(self.stamps)

    def __getitem__(self, name):
        """One state over time."""
        return self.states[:, self._index(name)]

    def bound(self, name):
        """The guaranteed bound on the error of one state over time."""
        return self.error_bounds[:, self._index(name)]

    def deviation(self, name):
        """The square root of the variance of one state over time; needs a covariance."""
        if self.covariances is None:
            raise ValueError('these estimates have no covariance')
        i = self._index(name)
        return numpy.sqrt(self.covariances[:, i, i])

    def at(self, stamps, name):
        """One state at other stamps, interpolated linearly; NaN outside of the first and the last one."""
        return numpy.interp(stamps, self.stamps, self[name], left=numpy.nan, right=numpy.nan)

    def _index(self, name):
        if name not in self.names:
            raise KeyError(f'expected one of the states {", ".join(self.names)}, found {name}')
        return self.names.index(name)


class Events:
    """The messages EventStatus of one topic, in the order in which they were received.

    stamps    N stamps of the events [s]
    received  N times of their arrival [s]
    sources   N names: of sensors, of inputs, or jumps
    kinds     N of SAMPLE, INPUT, JUMP …, as text
    outcomes  N of USED, USED_LATE, GATED …, as text
    reasons   N texts
    intervals, rewound, gate_share, nis  N numbers, as in EventStatus
    innovations  N lists
    """

    KINDS = {getattr(EventStatus, name): name for name in ('INPUT', 'JUMP', 'JUMP_OUTPUT', 'OUTPUT', 'SAMPLE', 'WITHDRAWAL')}

    def __init__(self, messages):
        outcomes = _outcomes()
        self.stamps = numpy.array([message.header.stamp.to_sec() for message in messages])
        self.received = self.stamps + numpy.array([message.latency for message in messages])
        self.sources = numpy.array([message.source for message in messages])
        self.kinds = numpy.array([self.KINDS[message.kind] for message in messages])
        self.outcomes = numpy.array([outcomes[message.outcome] for message in messages])
        self.reasons = [message.reason for message in messages]
        self.intervals = numpy.array([message.interval for message in messages])
        self.rewound = numpy.array([message.rewound for message in messages])
        self.gate_share = numpy.array([message.gate_share for message in messages])
        self.nis = numpy.array([message.nis for message in messages])
        self.innovations = [numpy.array(message.innovation) for message in messages]

    def __len__(self):
        return len(self.stamps)

    def of(self, source):
        """Which of them came from a source: N of true and false, to be used as an index."""
        return self.sources == source


def _outcomes():
    """Outcomes by their numbers: the constants of EventStatus between USED and the first INTERVAL_."""
    others = set(Events.KINDS.values())
    return {value: name for name, value in vars(EventStatus).items()
            if name.isupper() and isinstance(value, int) and name not in others
            and not name.startswith(('INTERVAL_', 'DWELL_'))}


def read_estimates(bag, topic='estimate'):
    """The estimates, or the truth, that a bag has on a topic, with or without the slash in front.

    Raises ValueError where the bag has none.
    """
    return Estimates(_messages(bag, topic, 'sampled_data_observers/StateEstimate'))


def read_events(bag, topic='events'):
    """What became of each event, as the observer answered on a topic. Raises ValueError where the bag has none."""
    return Events(_messages(bag, topic, 'sampled_data_observers/EventStatus'))


def _messages(path, topic, message_type):
    with rosbag.Bag(str(path)) as bag:
        topics = bag.get_type_and_topic_info().topics
        found = [name for name, info in topics.items()
                 if name.strip('/') == topic.strip('/') and info.msg_type == message_type]
        messages = [message for _, message, _ in bag.read_messages(topics=found)] if found else []
    if not messages:
        there = [name for name, info in topics.items() if info.msg_type == message_type]
        raise ValueError(f'{path}: expected messages {message_type} on the topic {topic}, found them on: '
                         f'{", ".join(sorted(there)) or "none"}')
    return messages
