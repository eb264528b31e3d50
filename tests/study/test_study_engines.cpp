// Rows by GNU parallel and by Snakemake, where they are installed: the same table as one process makes.

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

INSTANTIATE_TEST_SUITE_P(Installed, Engine, ::testing::Values("parallel", "snakemake"));

}  // namespace
}  // namespace tremie
