#pragma once

#include <string>

#include "replay/summary.h"

namespace sampled_data_observers {

/// Draws truth, samples, estimate and its guaranteed bounds of every quantity into a picture (its
/// format by the ending), with the program plot_replay that lies beside this one.
/// @throws ReplayError when the picture can't be drawn.
void draw_plot(const ReplaySummary& summary, const std::string& path);

}  // namespace sampled_data_observers
