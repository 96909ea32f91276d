#include <iostream>
#include <memory>

#include "flexura/app/campaign.h"
#include "flexura/app/command_line.h"

namespace flexura {
namespace {

void add_campaign(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CampaignArguments>();
  CLI::App* command =
      add_command(app, "campaign", command_group::experiments,
                  "Run an experiment many times with varied values; the same command continues "
                  "after an interruption",
                  "flexura campaign campaign.toml --dry-run\n"
                  "flexura campaign campaign.toml --out trial.db\n"
                  "flexura report trial.db");
  command->add_option("CAMPAIGN", arguments->campaign, "The campaign file (TOML)")->type_name("")->required();
  command->add_option("--out", arguments->out, "File of the results (default: results/NAME.db)")
      ->type_name("FILE");
  command
      ->add_option("--set", arguments->sets, "Change a value of the campaign file: samples=20 (repeatable)")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--workers", arguments->workers,
                   "Runs at the same time, 1 to 4096 (default: the number of processors)")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{4096}).description(""));
  command->add_flag("--safe-from-power-loss", arguments->is_safe_from_power_loss,
                    "Wait for the disk after each group of runs");
  command->add_flag("--dry-run", arguments->dry_run,
                    "Print how many runs there are, and about how long they take");
  command->add_flag("--json", arguments->json, "Print one JSON document");
  command->callback([&chosen, arguments] {
    chosen = [arguments] { return campaign_command(*arguments, std::cout, std::cerr); };
  });
}

void add_report(CLI::App& app, Command& chosen) {
  auto arguments = std::make_shared<CampaignReportArguments>();
  CLI::App* command = add_command(app, "report", command_group::experiments,
                                  "Write a page about the results of a campaign, also while it runs",
                                  "flexura report results/campaign.db");
  command->add_option("FILE", arguments->results, "Results of `flexura campaign`")->type_name("")->required();
  command->add_option("--out", arguments->out, "The page (default: the name of the results with .html)")
      ->type_name("FILE");
  command->callback([&chosen, arguments] {
    chosen = [arguments] { return campaign_report_command(*arguments, std::cout); };
  });
}

}  // namespace

void add_campaign_commands(CLI::App& app, Command& chosen) {
  add_campaign(app, chosen);
  add_report(app, chosen);
}

}  // namespace flexura
