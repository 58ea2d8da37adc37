// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include "study/figures/text.hpp"

namespace {
using namespace altiplan;
using namespace altiplan::cli;

/// The command line as typed, quoted so that a shell accepts it again.
std::string command_line(int argc, char** argv) {
  std::string line = "altiplan";
  for (int i = 1; i < argc; ++i) {
    line += " " + study::report::shell(argv[i]);
  }
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program(argc, argv, [&](App& app, Action& action) {
    add_go(app, action);
    add_survey(app, action);
    add_info(app, action);
    add_run(app, action);
    add_validate(app, action);
    add_set(app, action);
    add_explain(app, action);
    add_check(app, action);
    add_view(app, action);
    add_edit(app, action);
    add_export(app, action);
    add_upload(app, action);
    add_fly(app, action);
    add_download(app, action);
    add_status(app, action);
    add_plugins(app, action);
    add_merge(app, action);
    add_replay(app, action);
    add_compare(app, action);
    add_slurm(app, action);
    add_study(app, action, command_line(argc, argv));
    add_report(app, action);
    add_reproduce(app, action, command_line(argc, argv));
    add_tune(app, action);
    add_new(app, action);
    add_check_plugin(app, action);
    add_completion(app, action);
    add_man(app, action);
  });
}
