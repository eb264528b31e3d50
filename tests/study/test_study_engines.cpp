// Rows by GNU parallel, Snakemake and Slurm, where they are installed: the same table as one process makes, the time
// that each row took left out.

#include <gtest/gtest.h>

#include "tests/apparatus/shell.hpp"
#include "tests/study/quick_study.hpp"

namespace tremie {
namespace {

class Engine : public ::testing::TestWithParam<const char*> {};

TEST_P(Engine, MakesTheTableOfOneProcess) {
  const std::string engine = GetParam();
  if (test::shell("command -v " + engine, "/tmp").code != 0) GTEST_SKIP() << engine << " is not installed";
  const test::TemporaryFolder folder;
  test::write_quick_study(folder, "method = \"grid\"\nlevels = 3\n");
  const auto tremie = [&](const std::string& arguments) {
    return test::shell("'" TREMIE_PROGRAM "' study STUDY.toml " + arguments, folder.path());
  };
  ASSERT_EQ(tremie("--out one --quiet").code, 0);
  const auto result = tremie("--out many --jobs 2 --engine " + engine + " --submit");
  ASSERT_EQ(result.code, 0) << result.text;
  EXPECT_EQ(test::without_cpu(test::read_file(folder / "many/study.csv")),
            test::without_cpu(test::read_file(folder / "one/study.csv")));
}

bool can_start_slurm() {
  return test::shell("command -v slurmctld slurmd munged sbatch && test $(id -u) = 0", "/tmp").code == 0;
}

// A job array on a Slurm of this test's own. A row that never came is named, and one that is sent for twice is run once.
TEST(Slurm, ArrayMakesTheTableOfOneProcess) {
  if (!can_start_slurm()) GTEST_SKIP() << "Slurm and munge are not installed, or this is not root";
  const test::TemporaryFolder folder;
  test::write_quick_study(folder, "method = \"grid\"\nlevels = 3\n");
  const std::string study = "'" TREMIE_PROGRAM "' study STUDY.toml ";
  ASSERT_EQ(test::shell(study + "--out one --quiet", folder.path()).code, 0);
  const std::string submit = study + "--out many --force --engine slurm --submit";
  const std::string wait = "while [ -n \"$(squeue --noheader)\" ]; do sleep 0.2; done";
  test::write_file(folder / "jobs.sh", "set -e\n" + submit + "\n" + wait + "\nrm many/rows/4.json\n" + study +
                                           "--out many --collect || [ $? = 3 ]\nsbatch many/study.sbatch\n" +
                                           wait + "\n" + study + "--out many --collect\n");
  const auto result =
      test::shell("'" TREMIE_SLURM "' '" + (folder / "slurm").string() + "' sh jobs.sh", folder.path());
  ASSERT_EQ(result.code, 0) << result.text;
  EXPECT_NE(result.text.find("1 of 6 rows are missing: 4"), std::string::npos) << result.text;
  EXPECT_EQ(test::without_cpu(test::read_file(folder / "many/study.csv")),
            test::without_cpu(test::read_file(folder / "one/study.csv")));
}

INSTANTIATE_TEST_SUITE_P(Installed, Engine, ::testing::Values("parallel", "snakemake"));

}  // namespace
}  // namespace tremie
