"""Estimates, events, a gain file and a report in NumPy, cell by cell; doc/tutorials/python.md says how it is run.

Cells begin with `# %%`, as Jupyter (by jupytext), Spyder and VS Code know them.
"""
# %% What the tools wrote
import numpy
from matplotlib import pyplot

import sampled_data_observers as sdo

estimates = sdo.read_estimates('cart_estimates.bag')      # written by replay -o, or recorded live
truth = sdo.read_estimates('cart.bag', topic='truth')     # written by simulate
events = sdo.read_events('cart_estimates.bag')
gains = sdo.read_gains('cart_gains.yaml')

print(f'{len(estimates)} estimates of {", ".join(estimates.names)}, {len(events)} events')
print('L =', gains['gains']['L'].ravel())

# %% The error, and its guaranteed bound
error = truth.at(estimates.stamps, 'v') - estimates['v']
settled = (estimates.stamps > truth.stamps[0] + 5) & ~numpy.isnan(error)
share = numpy.abs(error[settled]) / estimates.bound('v')[settled]
print(f'v is {numpy.sqrt(numpy.mean(error[settled]**2)):.3f} m/s off (RMS), at most {share.max():.0%} of its bound')

# %% How late samples came
latency = events.received - events.stamps
print(f'samples came {latency.mean() * 1e3:.0f} ms late on average, {latency.max() * 1e3:.0f} ms at most; '
      f'{numpy.count_nonzero(events.outcomes == "USED")} were used as the newest event')

# %% The eigenvalues of the error from sample to sample, for the shortest and the longest time between them
A = numpy.array([[0, 1], [0, 0]])
C = numpy.array([[1, 0]])
for T in gains['sampling'].values():
    step = (numpy.eye(2) + A * T) @ (numpy.eye(2) - gains['gains']['L'] @ C)   # e^(A T), since A A = 0
    print(f'T = {T} s: |eigenvalues| =', numpy.round(numpy.abs(numpy.linalg.eigvals(step)), 3))

# %% A picture
time = estimates.stamps - truth.stamps[0]
figure, axis = pyplot.subplots(figsize=(9, 4))
axis.plot(truth.stamps - truth.stamps[0], truth['v'], color='0.6', linewidth=2.5, label='truth')
axis.plot(time, estimates['v'], label='estimate')
axis.fill_between(time, estimates['v'] - estimates.bound('v'), estimates['v'] + estimates.bound('v'), alpha=0.15,
                  label='guaranteed bound')
axis.set(xlabel='time [s]', ylabel='velocity [m/s]', ylim=(-1.2, 1.2))
axis.legend()
figure.savefig('cart_velocity.png', dpi=100)

# %% All of it for MATLAB
sdo.save_mat('cart.mat', estimates=estimates, truth=truth, events=events, gains=gains)
