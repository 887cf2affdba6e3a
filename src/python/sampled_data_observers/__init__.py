"""What sampled_data_observers writes, in NumPy: estimates and events of bags, summaries and reports of
replays, gain files; and their export for MATLAB. Nothing of it runs an observer."""
from sampled_data_observers.estimates import Estimates, Events, read_estimates, read_events
from sampled_data_observers.gains import read_gains
from sampled_data_observers.matlab import save_mat
from sampled_data_observers.reports import read_report, read_summary

__all__ = ['Estimates', 'Events', 'read_estimates', 'read_events', 'read_gains', 'read_report', 'read_summary', 'save_mat']
