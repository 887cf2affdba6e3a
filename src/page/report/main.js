// The page of a report: sections from top to bottom.

beginPage(`${data.observer} on ${data.bag}`, `Replay report. Times are in seconds after ${data.origin.toFixed(3)} s.`);
prepareRun();
verdictSection();
errorsSection();
statesSection();
normSection();
seedsSection();
lyapunovSection();
pathSection();
hybridSection();
innovationsSection();
intervalsSection();
delaysSection();
eventsSection();
configurationSection();
makeToolbar(run.range);
