// SPDX-License-Identifier: Apache-2.0
// make_store FILE: a store of the runs that JSON on stdin says, for tests of what reads stores:
// {"study": {…}, "scenarios": [{"name", "of"}…], "pipelines": […], "sessions": n,
//  "runs": [{"key", "scenario", "pipeline", "repetition", "seed", "outcome", "message", "result",
//            "trace", "values": {…}}…]}
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>

#include "host/result/result_json.hpp"
#include "study/store/store.hpp"

namespace altiplan::host {
using namespace study;
namespace {

std::vector<StoredVariant> variants(const Json& list) {
  std::vector<StoredVariant> all;
  for (const Json& entry : list) {
    all.push_back({entry.at("name"), entry.value("of", ""), entry.value("file", ""), {}});
  }
  return all;
}

StoredRun run_of(const Json& json, std::int64_t session) {
  StoredRun run;
  run.key = json.at("key");
  run.scenario = json.at("scenario");
  run.pipeline = json.at("pipeline");
  run.repetition = json.value("repetition", 0);
  run.seed = json.value("seed", std::int64_t(0));
  run.outcome = json.value("outcome", "solved");
  run.message = json.value("message", "");
  run.result = json.value("result", "");
  run.trace = json.value("trace", "");
  run.session = session;
  if (json.contains("values")) {
    for (const auto& [name, value] : json.at("values").items()) {
      run.values.emplace_back(name, value.get<double>());
    }
  }
  std::sort(run.values.begin(), run.values.end());
  return run;
}

void make(const char* file) {
  const Json json = Json::parse(std::cin);
  Store store(file, StoreMode::write);
  store.set_study(json.at("study").get<std::map<std::string, std::string>>());
  store.add_variants(variants(json.at("scenarios")), variants(json.at("pipelines")));
  std::int64_t session = 0;
  for (int n = 0; n < json.value("sessions", 1); ++n) {
    StoredSession made;
    made.started = "2026-11-21T18:00:0" + std::to_string(n % 10) + "Z";
    made.command = "altiplan study study.yaml --out study.db";
    made.version = "0.1.0";
    made.host = "machine";
    made.cpu = "a processor";
    made.cores = 2;
    made.memory_mb = 16384;
    made.jobs = 2;
    session = store.add_session(made);
  }
  std::vector<StoredRun> runs;
  for (const Json& run : json.at("runs")) {
    runs.push_back(run_of(run, session));
  }
  store.add(runs);
}
}  // namespace
}  // namespace altiplan::host

int main(int argc, char** argv) {
  try {
    if (argc != 2) {
      throw std::runtime_error("usage: make_store FILE < JSON");
    }
    altiplan::host::make(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_store: %s\n", error.what());
    return 1;
  }
  return 0;
}
