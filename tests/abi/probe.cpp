// SPDX-License-Identifier: Apache-2.0
// Names what crosses between the host and a plugin, for abidiff: of the interfaces, libaltiplan.so
// itself has no function that shows how they are laid out. Built against the SDK of each version,
// so that nothing later than the oldest of them may stand here.
#include "altiplan/constraint.hpp"
#include "altiplan/environment.hpp"
#include "altiplan/local_planner.hpp"
#include "altiplan/planner.hpp"
#include "altiplan/plugin_abi.hpp"
#include "altiplan/smoother.hpp"
#include "altiplan/tuner.hpp"

#define ALTIPLAN_PROBE(Type) \
  ALTIPLAN_API void probe_##Type(altiplan::Type*) {}

ALTIPLAN_PROBE(Environment)
ALTIPLAN_PROBE(Constraint)
ALTIPLAN_PROBE(Planner)
ALTIPLAN_PROBE(Session)
ALTIPLAN_PROBE(LocalPlanner)
ALTIPLAN_PROBE(Pilot)
ALTIPLAN_PROBE(Smoother)
ALTIPLAN_PROBE(Tuner)
ALTIPLAN_PROBE(Search)
ALTIPLAN_PROBE(Trace)

ALTIPLAN_PROBE(PluginEntry)
ALTIPLAN_PROBE(ParamReport)
ALTIPLAN_PROBE(Site)
ALTIPLAN_PROBE(World)
ALTIPLAN_PROBE(Request)
ALTIPLAN_PROBE(PlanResult)
ALTIPLAN_PROBE(Observation)
ALTIPLAN_PROBE(PilotStep)
ALTIPLAN_PROBE(Violation)
ALTIPLAN_PROBE(Path)
ALTIPLAN_PROBE(Manifest)
