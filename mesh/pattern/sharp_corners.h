// Finds the sharp corners of a drawing: two segments meet there at less than 60 degrees inside the panel.
//   Both sides of such a corner begin with a piece of the same length, its collar, and these are halved
//   together [Ruppert 1995, section 5.2; Shewchuk 2002].
#pragma once

#include "mesh/pattern/delaunay.h"
#include "mesh/pattern/sides.h"

namespace drape::internal {

inline constexpr double kSameFraction = 1e-7;  // fractions of a run that differ by less are the same

// The fraction of the run's class that belongs to the fraction f of the run, and the other way round.
inline double class_fraction(const ChainRun& run, double f) { return run.turned ? 1 - f : f; }
double leg_fraction(const ChainRun& run, int leg, bool at_end);  // fraction of a run at an end of a leg

// Fills in the clusters, the sharp ends of the legs, and the corners below the smallest angle [rad].
void find_sharp_corners(const Pattern& pattern, double min_angle, Sides& sides);

// The length of the collar at each cluster [m]: the same for all its legs, and the same at equal fractions of
// curves that are sewn.
std::vector<double> collars(const Sides& sides, double edge);

// The corner (a vertex of the panel) at an end of a leg.
int corner_of(const Sides& sides, int leg, bool at_end);

// Whether two vertices of a panel are on different legs of a sharp corner, equally far from it.
bool span_sharp_corner(const Sides& sides, const Delaunay& mesh, int panel, int u, int w);

}  // namespace drape::internal
