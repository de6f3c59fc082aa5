// The command line of `aircut job`.
#include "cli/job_arguments.h"

#include <CLI/CLI.hpp>

namespace aircut::cli {

CLI::App* add_job(CLI::App& app, JobArguments& a) {
  CLI::App* c = app.add_subcommand(
      "job",
      "run the operations of a job one after the other, each with the stock that one before left;\n"
      "one verdict over all\n\n"
      "  aircut job programs/jobs/bracket.job.toml -o out");
  c->add_option("JOB", a.file, "the operations (docs/cli.md)")->required();
  c->add_option("-o,--out", a.folder, "folder; each operation gets one of its own in it")
      ->type_name("DIR");
  c->add_flag("--force", a.force, "write into a folder that exists, replace saved stocks");
  c->add_option("--frames", a.frames, "as of run (repeatable)")
      ->allow_extra_args(false)
      ->type_name("WHEN");
  c->add_flag("-q,--quiet", a.output.quiet, "print the verdicts only");
  return c;
}

}  // namespace aircut::cli
