#include "core/logs/crinex.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>

#include "core/base/random.h"
#include "core/logs/rinex_lines.h"

namespace lodemark {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string Preamble(std::string_view version) {
  std::string text(version);
  text.resize(20, ' ');
  text += "COMPACT RINEX FORMAT";
  text.resize(60, ' ');
  text += "CRINEX VERS   / TYPE\n";
  std::string program = "RNX2CRX ver.4.1.0";
  program.resize(60, ' ');
  return text + program + "CRINEX PROG / DATE\n";
}

// Lines that come out of a compressed text, with \n after each.
std::string Decompress(const std::string& text, ReadReport* report) {
  RinexLines lines(LineReader::FromMemory("test.crx", text), report);
  std::string all;
  std::string_view line;
  while (lines.Next(&line)) all.append(line).push_back('\n');
  return all;
}

// Made up observations and what RNX2CRX 4.1.0 makes of them. Two satellites of three fall out and
// come back, an event stands between, the third epoch has 13 satellites.
constexpr std::string_view kVersion1 =
    R"(     2.11           OBSERVATION DATA    M (MIXED)           RINEX VERSION / TYPE
     6    C1    L1    D1    S1    P2    L2                  # / TYPES OF OBSERV
                                                            END OF HEADER
&20  1  1  0  0  0.0000000  0  3G01G05R13

3&20001000123 3&100000003300 3&-1500 3&45100 3&20000001000 3&-10000000000   02   2  2
3&20005000615 3&100000016500    3&-50000000000   06      2
3&20013001599 3&100000042900    3&-130000000000   05      2
                3        3

1500 -2200  0  1000   1
7500 -2200    1000   1
19500 -2200    1000   1
&                           4  1
an event                                                    COMMENT
&20  1  1  0  1  0.0000006  0  3G01G05R13

3&20001006123 3&99999985700 3&-1500 3&45100 3&20000001000 3&-9999998000   02   2  2
3&20005030615 3&99999998900    3&-49999998000   06      2
3&20013079599 3&100000025300    3&-129999998000   05      2
                3        9  1 1      2G0 G04G05G06G07G08G09G10G11G12G13
3&100370367
7500 -41800 0 0 0 1000   1
3&20002027246 3&99999947200    3&-19999997000   13      2
3&20003040869 3&99999950500    3&-29999997000   14      2
3&20004054492 3&99999953800    3&-39999997000   15      2
37500 -41800    1000   1
3&20006081738 3&99999960400    3&-59999997000   17      2
3&20007095361 3&99999963700    3&-69999997000   18      2
3&20008108984 3&99999967000    3&-79999997000   19      2
3&20009122607 3&99999970300    3&-89999997000   11      2
3&20010136230 3&99999973600    3&-99999997000   12      2
3&20011149853 3&99999976900    3&-109999997000   13      2
3&20012163476 3&99999980200    3&-119999997000   14      2
3&20013177099 3&99999983500    3&-129999997000   15      2
              2 &       12  0 &2   R13&&&&&&&&&&&&&&&&&&&&&&&&&&&&&&&&&

3000 -39600 0 0 0 0   0
3&20013313599 3&99999902100    3&-129999996000   05      2
)";

constexpr std::string_view kVersion1Plain =
    R"(     2.11           OBSERVATION DATA    M (MIXED)           RINEX VERSION / TYPE
     6    C1    L1    D1    S1    P2    L2                  # / TYPES OF OBSERV
                                                            END OF HEADER
 20  1  1  0  0  0.0000000  0  3G01G05R13
  20001000.123   100000003.30002        -1.500          45.100 2  20000001.000
 -10000000.0002
  20005000.615   100000016.50006
 -50000000.0002
  20013001.599   100000042.90005
-130000000.0002
 20  1  1  0  0 30.0000003  0  3G01G05R13
  20001001.623   100000001.10012                        45.100 2
  -9999999.0002
  20005008.115   100000014.30016
 -49999999.0002
  20013021.099   100000040.70015
-129999999.0002
                            4  1
an event                                                    COMMENT
 20  1  1  0  1  0.0000006  0  3G01G05R13
  20001006.123    99999985.70002        -1.500          45.100 2  20000001.000
  -9999998.0002
  20005030.615    99999998.90006
 -49999998.0002
  20013079.599   100000025.30005
-129999998.0002
 20  1  1  0  1 30.0000009  1 13G01G02G03G04G05G06G07G08G09G10G11G12 0.100370367
                                G13
  20001013.623    99999943.90012        -1.500          45.100 2  20000001.000
  -9999997.0002
  20002027.246    99999947.20013
 -19999997.0002
  20003040.869    99999950.50014
 -29999997.0002
  20004054.492    99999953.80015
 -39999997.0002
  20005068.115    99999957.10016
 -49999997.0002
  20006081.738    99999960.40017
 -59999997.0002
  20007095.361    99999963.70018
 -69999997.0002
  20008108.984    99999967.00019
 -79999997.0002
  20009122.607    99999970.30011
 -89999997.0002
  20010136.230    99999973.60012
 -99999997.0002
  20011149.853    99999976.90013
-109999997.0002
  20012163.476    99999980.20014
-119999997.0002
  20013177.099    99999983.50015
-129999997.0002
 20  1  1  0  2  0.0000012  0  2G01R13
  20001024.123    99999862.50002        -1.500          45.100 2  20000001.000
  -9999996.0002
  20013313.599    99999902.10005
-129999996.0002
)";

// The same with version 3: a receiver clock that is missing once, values that are missing.
constexpr std::string_view kVersion3 =
    R"(     3.04           OBSERVATION DATA    M (MIXED)           RINEX VERSION / TYPE
G    3 C1C L1C S1C                                          SYS / # / OBS TYPES
E    2 C1X L1X                                              SYS / # / OBS TYPES
                                                            END OF HEADER
> 2020 01 01 00 00  0.0000000  0  2      G01E05
3&0
3&20001000123 3&-99999996700 3&45100 &&02&&
3&20005000615 3&-99999983500 &&06
                   3
-123456789
1500 -2200 -250   1
7500 -2200   1
                 1 &

3000 -13200 0   0
15000 -13200   0
                   3                     E 5G30
3&-370370367
0 -13200   1
3&20030408690 3&-99999960400 3&47250 &&14&&
                 2 &                     G 1E05
-123456789
3&20001024123  3&44100 &&1&&&
0     &
>                              4  1
an event                                                    COMMENT
> 2020 01 01 00 02 30.0000000  0  2      G01E05
3&-617283945
3&20001037623 3&-100000271700 3&43850 &&12&&
3&20005188115 3&-100000258500 &&16
)";

constexpr std::string_view kVersion3Plain =
    R"(     3.04           OBSERVATION DATA    M (MIXED)           RINEX VERSION / TYPE
G    3 C1C L1C S1C                                          SYS / # / OBS TYPES
E    2 C1X L1X                                              SYS / # / OBS TYPES
                                                            END OF HEADER
> 2020 01 01 00 00  0.0000000  0  2       0.000000000000
G01  20001000.123   -99999996.70002        45.100
E05  20005000.615   -99999983.50006
> 2020 01 01 00 00 30.0000000  0  2      -0.000123456789
G01  20001001.623   -99999998.90012        44.850
E05  20005008.115   -99999985.70016
> 2020 01 01 00 01  0.0000000  0  2
G01  20001006.123  -100000014.30002        44.600
E05  20005030.615  -100000001.10006
> 2020 01 01 00 01 30.0000000  0  2      -0.000370370367
E05  20005068.115  -100000042.90016
G30  20030408.690   -99999960.40014        47.250
> 2020 01 01 00 02  0.0000000  0  2      -0.000493827156
G01  20001024.123                1         44.100
E05  20005120.615                1
>                              4  1
an event                                                    COMMENT
> 2020 01 01 00 02 30.0000000  0  2      -0.000617283945
G01  20001037.623  -100000271.70012        43.850
E05  20005188.115  -100000258.50016
)";

TEST(Crinex, RestoresWhatRnx2crxCompressedFromVersion2) {
  ReadReport report;
  EXPECT_EQ(Decompress(Preamble("1.0") + std::string(kVersion1), &report), kVersion1Plain);
  EXPECT_EQ(report.rows_skipped, 0);
  EXPECT_EQ(report.values_dropped, 0);
}

TEST(Crinex, RestoresWhatRnx2crxCompressedFromVersion3) {
  ReadReport report;
  EXPECT_EQ(Decompress(Preamble("3.0") + std::string(kVersion3), &report), kVersion3Plain);
  EXPECT_EQ(report.rows_skipped, 0);
  EXPECT_EQ(report.values_dropped, 0);
}

TEST(Crinex, LeavesPlainRinexAlone) {
  ReadReport report;
  EXPECT_EQ(Decompress(std::string(kVersion3Plain), &report), kVersion3Plain);
}

TEST(Crinex, StartsAgainAtTheNextFullEpochAfterDamage) {
  std::string text(kVersion3);
  const std::size_t second_epoch = text.find("                   3\n");
  text.replace(second_epoch, 20, std::string(32, ' ') + "xxx");
  ReadReport report;
  const std::string lines = Decompress(Preamble("3.0") + text, &report);
  EXPECT_GT(report.rows_skipped, 0);
  EXPECT_THAT(lines, HasSubstr("G01  20001000.123"));
  EXPECT_THAT(lines, HasSubstr("> 2020 01 01 00 02 30.0000000"));
  EXPECT_THAT(lines, HasSubstr("E05  20005188.115  -100000258.50016"));
  EXPECT_THAT(lines, Not(HasSubstr("20001001.623")));
}

TEST(Crinex, NoticesAnEpochThatLacksLines) {
  std::string text(kVersion3);
  const std::size_t row = text.find("3&20005188115");
  const std::string full_epoch = "> 2020 01 01 00 03  0.0000000  0  1      G01\n\n3&20000000000\n";
  text.replace(row, text.size() - row, full_epoch);
  ReadReport report;
  const std::string lines = Decompress(Preamble("3.0") + text, &report);
  EXPECT_EQ(report.rows_skipped, 1);
  EXPECT_THAT(lines, HasSubstr("> 2020 01 01 00 03  0.0000000  0  1\nG01  20000000.000\n"));
}

TEST(CrinexArc, RestoresAnySeriesFromDifferencesOfAnyOrder) {
  Random random(7);
  for (int order = 0; order <= CrinexArc::kHighestOrder; ++order) {
    CrinexArc arc;
    std::array<std::int64_t, 11> before = {};  // differences of the value before, by order
    for (int n = 0; n < 40; ++n) {
      const auto value = static_cast<std::int64_t>(random.Uniform() * 1e12) - 500'000'000'000;
      std::array<std::int64_t, 11> now = {value};
      const int level = std::min(n, order);
      for (std::size_t i = 1; i <= static_cast<std::size_t>(level); ++i) {
        now[i] = now[i - 1] - before[i - 1];
      }
      const std::string number = std::to_string(now[static_cast<std::size_t>(level)]);
      ASSERT_TRUE(arc.Take(n == 0 ? std::to_string(order) + "&" + number : number));
      ASSERT_EQ(arc.value(), value) << "order " << order << ", value " << n;
      before = now;
    }
  }
}

TEST(CrinexArc, RefusesWhatItCannotContinue) {
  CrinexArc arc;
  EXPECT_FALSE(arc.Take("5"));
  EXPECT_TRUE(arc.Take("3&100"));
  EXPECT_TRUE(arc.Take("5"));
  EXPECT_EQ(arc.value(), 105);
  arc.End();
  EXPECT_FALSE(arc.Take("5"));
  for (const char* text : {"&1", "3&", "33&1", "x&1", "3&1x", "3&1&1", "--1", "1e3", "3& 1"}) {
    EXPECT_FALSE(arc.Take(text)) << text;
  }
}

TEST(CrinexArc, EndsRatherThanOverflows) {
  CrinexArc arc;
  const std::string huge = std::to_string(std::numeric_limits<std::int64_t>::max());
  EXPECT_FALSE(arc.Take("3&" + huge));
  EXPECT_TRUE(arc.Take("3&9999999999999"));
  EXPECT_FALSE(arc.Take(huge));
  EXPECT_FALSE(arc.Take("1"));
  EXPECT_FALSE(arc.Take("3&10000000000000"));
  EXPECT_FALSE(arc.Take("3&-1000000000000"));  // F14.3 has room for one digit less
}

}  // namespace
}  // namespace lodemark
