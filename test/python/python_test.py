#!/usr/bin/env python3
"""The Python package reads what the tools write, and says what is wrong with anything else."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
import sampled_data_observers as sdo

SIMULATE, REPLAY = sys.argv[1:3]
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__)))), 'config', 'examples')
SCALAR = os.path.join(EXAMPLES, 'ferrante2016_scalar')


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        subprocess.run([SIMULATE, f'{SCALAR}/scenario.yaml', '-o', cls.path('run.bag')], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([REPLAY, cls.path('run.bag')] + [f'{SCALAR}/{name}.yaml' for name in ('scenario', 'observer', 'gains')] +
                       ['--truth', 'truth', '-o', cls.path('estimates.bag'), '--json', cls.path('summary.json'),
                        '--report', cls.path('report.html')], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def test_estimates_are_those_of_the_summary(self):
        estimates = sdo.read_estimates(self.path('estimates.bag'))
        truth = sdo.read_estimates(self.path('run.bag'), '/truth')
        summary = sdo.read_summary(self.path('summary.json'))
        name, = estimates.names
        self.assertEqual(estimates.states.shape, (summary['estimates'], 1))
        self.assertTrue(numpy.all(numpy.diff(estimates.stamps) > 0))
        self.assertEqual(summary['final_state'][name], estimates[name][-1])
        self.assertIsNone(estimates.covariances)
        error = truth.at(estimates.stamps, name) - estimates[name]
        self.assertAlmostEqual(summary['rmse'][name], numpy.sqrt(numpy.nanmean(error**2)), delta=0.1 * summary['rmse'][name])
        self.assertTrue(numpy.isnan(truth.at([0.0], name))[0])
        with self.assertRaisesRegex(KeyError, f'expected one of the states {name}, found speed'):
            estimates.bound('speed')

    def test_events_are_answered_one_by_one(self):
        events = sdo.read_events(self.path('estimates.bag'))
        used = numpy.isin(events.outcomes, ('USED', 'USED_LATE')) & (events.kinds == 'SAMPLE')
        self.assertEqual(sdo.read_summary(self.path('summary.json'))['samples_used'], used.sum())
        self.assertTrue(numpy.all(events.received >= events.stamps))
        self.assertEqual(len(events), events.of(events.sources[0]).sum() + (events.sources != events.sources[0]).sum())

    def test_reports_have_the_same_curves(self):
        report = sdo.read_report(self.path('report.html'))
        estimates = sdo.read_estimates(self.path('estimates.bag'))
        stamps = report['origin'] + report['time_unit'] * report['estimate_times']
        numpy.testing.assert_allclose(stamps, estimates.stamps, atol=1e-4)

    def test_gains_are_arrays(self):
        gains = sdo.read_gains(os.path.join(EXAMPLES, 'ferrante2019_oscillator', 'gains_timer_dependent.yaml'))
        self.assertEqual(gains['gains']['L'].shape, (2, 1))
        self.assertEqual(gains['certificate']['P']['0'].shape, (2, 2))
        kalman = sdo.read_gains(os.path.join(EXAMPLES, 'bernard2022_impulsive', 'gains_kalman.yaml'))
        self.assertEqual(kalman['gains']['P0'].ndim, 2)

    def test_numbers_are_numbers_however_they_are_written(self):
        with open(self.path('gains.yaml'), 'w') as file:
            file.write('gains: {Q: {diagonal: [1e-3, 2]}, L_d: [[tau/2], [1]], T2: .inf, form: linear}\n')
        gains = sdo.read_gains(self.path('gains.yaml'))['gains']
        numpy.testing.assert_array_equal(gains['Q'], [[1e-3, 0], [0, 2]])
        self.assertEqual(gains['L_d'][0], ['tau/2'])
        self.assertEqual((gains['T2'], gains['form']), (numpy.inf, 'linear'))

    def test_matlab_gets_structs(self):
        from scipy.io import loadmat
        sdo.save_mat(self.path('run.mat'), estimates=sdo.read_estimates(self.path('estimates.bag')),
                     gains={'camera/left': {'0': numpy.eye(2)}}, texts=['a', 'b'])
        read = loadmat(self.path('run.mat'), simplify_cells=True)
        self.assertEqual(read['estimates']['stamps'].shape, sdo.read_estimates(self.path('estimates.bag')).stamps.shape)
        numpy.testing.assert_array_equal(read['gains']['camera_left']['x0'], numpy.eye(2))
        with self.assertRaisesRegex(ValueError, 'a_b'):
            sdo.save_mat(self.path('run.mat'), gains={'a/b': 1.0, 'a-b': 2.0})

    def test_other_files_are_refused(self):
        with self.assertRaisesRegex(ValueError, 'on the topic nothing, found them on: /truth'):
            sdo.read_estimates(self.path('run.bag'), 'nothing')
        with open(self.path('other.yaml'), 'w') as file:
            json.dump({'plant': {}}, file)
        with self.assertRaisesRegex(ValueError, 'expected the key gains at the top of a gain file, found plant'):
            sdo.read_gains(self.path('other.yaml'))
        with self.assertRaisesRegex(ValueError, 'expected a page of replay --report'):
            sdo.read_report(self.path('other.yaml'))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
