// Campaign files: every combination once, keys that change with what a result depends on.
#include <catch2/catch.hpp>
#include <set>

#include "convergence/campaigns/job_keys.h"
#include "convergence/campaigns/sample.h"
#include "convergence/campaigns/sensitivity.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

using Catch::Matchers::Contains;

namespace {

using Jobs = std::vector<std::string>;

Campaign campaign_of(const std::string& text) {
  return read_campaign_text(text, "a/name.campaign.toml");
}

Jobs jobs_of(const Campaign& campaign) {
  Jobs jobs;
  for (size_t i = 0; i < campaign.root.jobs; ++i) {
    std::string job;
    for (const Assignment& a : job_assignments(campaign, i)) job += a.key + "=" + a.value + ";";
    jobs.push_back(job);
  }
  return jobs;
}

/// Numbers of the first axis, column by column.
std::vector<std::vector<double>> sampled(const Campaign& campaign) {
  const auto& rows = campaign.root.axes[0].rows;
  std::vector<std::vector<double>> columns(rows[0].size());
  for (const auto& row : rows)
    for (size_t k = 0; k < row.size(); ++k) columns[k].push_back(std::stod(row[k]));
  return columns;
}

std::string key_of(const std::string& text, const std::string& program,
                   const std::string& case_path) {
  const Campaign campaign = campaign_of(text);
  JobKeys keys(campaign, program, [&](const std::string&) { return case_path; });
  return keys.key_of(job_assignments(campaign, 0));
}

}  // namespace

TEST_CASE("campaign: a grid has every combination once, with what is set") {
  const Campaign campaign = campaign_of(
      "case = \"x\"\nset = { z = 7 }\n[grid]\na = [1, 2.5]\n\"b.c\" = [\"p\", \"q\", \"3\"]\n");
  CHECK(campaign.name == "name");
  const Jobs jobs = jobs_of(campaign);
  CHECK(std::set<std::string>(jobs.begin(), jobs.end()).size() == 6);
  CHECK(jobs.front() == "a=1;b.c=p;case=x;z=7;");
  CHECK(jobs.back() == "a=2.5;b.c=\"3\";case=x;z=7;");
  CHECK(varied_parameters(campaign) == Jobs{"a", "b.c"});
}

TEST_CASE("campaign: words of a command line are bare, values of --set are TOML") {
  const std::string both = "[grid]\n\"a.b\" = [\"2 up\"]\nsolver = [\"2 up\"]\n";
  CHECK(jobs_of(campaign_of("run = \"judge\"\n" + both))[0] == "a.b=\"2 up\";solver=2 up;");
  CHECK(jobs_of(campaign_of(both + "case = [\"2d\"]\n"))[0] ==
        "a.b=\"2 up\";case=2d;solver=\"2 up\";");
  CHECK(jobs_of(campaign_of("run = \"judge\"\n[set]\n\"settings.k\" = \"1\"\n"))[0] ==
        "settings.k=1;");
  const std::string broken = jobs_of(campaign_of("[grid]\na = [\"1\\n\\\"\\u0001\"]\n"))[0];
  CHECK(broken == "a=\"1\\u000a\\\"\\u0001\";");
  KeyTable table("", "");
  set_key(table, broken.substr(0, broken.size() - 1));
  CHECK(table.text("a") == "1\n\"\x01");
}

TEST_CASE("campaign: zipped lists go together, and the names in a folder's files are a list") {
  CHECK(jobs_of(campaign_of("[grid]\ng = [0, 1]\n[[zip]]\na = [1, 2]\nb = [4, 5]\n")) ==
        Jobs{"a=1;b=4;g=0;", "a=1;b=4;g=1;", "a=2;b=5;g=0;", "a=2;b=5;g=1;"});
  CHECK(jobs_of(campaign_of("[[zip]]\na = [{ b = 7 }, { b = [8, 9] }]\n")) ==
        Jobs{"a={ \"b\" = 7 };", "a={ \"b\" = [8, 9] };"});
  const ScratchFolder scratch;
  scratch.write("b.toml", "[[fault]]\nname = \"z\"\n[[other]]\nname = \"o\"\n");
  scratch.write("a.toml", "[fault.y-1]\nlaw = \"\"\n[fault.x]\n");
  const std::string text = "[grid]\nname = { folder = \".\", every = \"fault\" }\n";
  CHECK(jobs_of(read_campaign_text(text, scratch.write("d.txt", "no TOML"))) ==
        Jobs{"name=x;", "name=y-1;", "name=z;"});
}

TEST_CASE("campaign: parts are added, each with its own parameters; the innermost value counts") {
  CHECK(jobs_of(campaign_of(
            "[set]\nm = 0\n[grid]\ng = [1, 2]\n[[part]]\nset = { m = 1 }\n[part.grid]\nk = [7, 8]\n"
            "[[part]]\nset = { m = 2 }\n")) == Jobs{"g=1;k=7;m=1;", "g=2;k=7;m=1;", "g=1;k=8;m=1;",
                                                    "g=2;k=8;m=1;", "g=1;m=2;", "g=2;m=2;"});
}

TEST_CASE("campaign: ranges are spread evenly, or by factors, up to their very end") {
  const auto values = [](const std::string& range) {
    return sampled(campaign_of("[grid]\na = " + range + "\n"))[0];
  };
  CHECK(values("{ from = 1, to = 4, count = 4 }") == std::vector<double>{1, 2, 3, 4});
  const auto factors = values("{ from = 0.1, to = 1000, count = 5, spacing = \"log\" }");
  CHECK(factors[0] == 0.1);
  CHECK(factors[2] == Approx(10).epsilon(1e-14));
  CHECK(factors[4] == 1000);
}

TEST_CASE("campaign: a Latin hypercube has one sample in each stratum of every parameter") {
  const Campaign campaign = campaign_of(
      "[sample]\ncount = 40\nseed = 3\na = { from = 10, to = 20 }\n"
      "b = { mean = 5, deviation = 2 }\n");
  const auto columns = sampled(campaign);
  std::set<int> strata_of_a, strata_of_b;
  double together = 0;  // mean of (a - 15)(b - 5), of deviations 2.9 and 2: 5.8 where b follows a
  for (size_t k = 0; k < 40; ++k) {
    const double a = columns[0].at(k) - 15, b = columns[1].at(k) - 5;
    strata_of_a.insert(int((a + 5) * 4));
    strata_of_b.insert(int(40 * std::erfc(-b / 2 / std::sqrt(2.0)) / 2));
    together += a * b / 40;
  }
  CHECK(strata_of_a.size() == 40);
  CHECK(strata_of_b.size() == 40);
  CHECK(std::abs(together) < 5.8 / 2);  // three standard errors of independent parameters
  CHECK(normal_quantile(0.975) == Approx(1.959963984540054).epsilon(1e-13));
  CHECK(normal_quantile(1e-9) == Approx(-5.997807015007687).epsilon(1e-12));
}

TEST_CASE("sensitivity: the indices of Ishigami's function are found from a Latin hypercube") {
  // f = sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 over (-pi, pi)^3 (Ishigami and Homma 1990)
  const double pi = 3.14159265358979323846, a = 7, b = 0.1;
  const double from_x1 = std::pow(1 + b * std::pow(pi, 4) / 5, 2) / 2, from_x2 = a * a / 8;
  const double variance = a * a / 8 + b * std::pow(pi, 4) / 5 + b * b * std::pow(pi, 8) / 18 + 0.5;
  const double exact[3] = {from_x1 / variance, from_x2 / variance, 0};
  const std::string range = " = { from = -3.14159265358979323846, to = 3.14159265358979323846 }\n";
  for (const char* seed : {"3", "17", "40"}) {
    const Campaign campaign = campaign_of(std::string("[sample]\ncount = 2000\nseed = ") + seed +
                                          "\nx1" + range + "x2" + range + "x3" + range);
    CHECK(sampled_parameters(campaign) == Jobs{"x1", "x2", "x3"});
    const auto x = sampled(campaign);
    std::vector<double> f;
    for (size_t k = 0; k < x[0].size(); ++k)
      f.push_back((1 + b * std::pow(x[2][k], 4)) * std::sin(x[0][k]) +
                  a * std::pow(std::sin(x[1][k]), 2));
    for (size_t k = 0; k < 3; ++k) {
      const FirstOrderIndex found = first_order_index(x[k], f);
      CAPTURE(seed, k, found.index, found.error);
      CHECK(found.bins == 44);
      CHECK(std::abs(found.index - exact[k]) < 3 * found.error);  // 370 to 1 for a normal error
      CHECK(found.error < 0.034);  // twice 2 sqrt(s) (1 - s)/sqrt(n), its largest for a normal y
    }
  }
}

TEST_CASE("sensitivity: without scatter, with too few samples, and with values that are missing") {
  std::vector<double> x, line;
  for (int k = 0; k < 400; ++k) {
    x.push_back(0.7 * ((k * 37) % 400));
    line.push_back(3 - 2 * x.back());
  }
  // bins of a straight line keep 1/400 of its variance to themselves
  CHECK(first_order_index(x, line).index == Approx(1).margin(2.0 / 400));
  for (const double constant : {5.0, std::nan("")})
    CHECK(std::isnan(first_order_index(x, std::vector<double>(400, constant)).index));
  CHECK(std::isnan(first_order_index(std::span(x).first(39), std::span(line).first(39)).index));
  for (size_t k = 0; k < line.size(); k += 2) line[k] = std::nan("");
  CHECK(first_order_index(x, line).samples == 200);
  CHECK(first_order_index(x, line).index == Approx(1).margin(2.0 / 196));
}

TEST_CASE("campaign: a key changes with everything that a result depends on, and nothing else") {
  const ScratchFolder scratch;
  const std::string mesh = scratch.write("m.obj", "v 0 0 0\n"),
                    body = "[cloth]\nmesh = \"m.obj\"\n", one = scratch.write("one.toml", body),
                    copy = scratch.write("copy.toml", body);
  const std::string text = "case = \"x\"\n[set]\n\"a.b\" = 1\n",
                    by_override = "case = \"x\"\n[set]\n\"cloth.mesh\" = \"" + mesh + "\"\n";
  const std::string key = key_of(text, "p", one), overridden = key_of(by_override, "p", copy);
  CHECK(key.size() == 32);
  CHECK(key_of(text, "p", copy) == key);
  CHECK(key_of("title = \"t\"\nkeep = \"all\"\n" + text + "[limits]\nseconds = 5\n", "p", one) ==
        key);
  CHECK(key_of(text, "q", one) != key);
  for (const std::string& other :
       {std::string("case = \"x\"\n[set]\n\"a.b\" = 2\n"),
        std::string("case = \"x\"\n[set]\n\"a.c\" = 1\n"), "run = \"check\"\n" + text,
        text + "[[quantity]]\nwhat = \"height\"\n"})
    CHECK(key_of(other, "p", one) != key);
  scratch.write("m.obj", "v 0 0 1\n");
  const std::string with_new_mesh = key_of(text, "p", one);
  CHECK(with_new_mesh != key);
  CHECK(key_of(by_override, "p", copy) != overridden);
  scratch.write("one.toml", body + "\n");
  CHECK(key_of(text, "p", one) != with_new_mesh);
}

TEST_CASE("wide key: the published values of FNV-1a, 128 bits") {
  // of the empty text the offset basis; lengths are hashed, too, so other texts have
  // no published one
  const auto text_of = [](const std::vector<std::string>& parts) {
    WideKey key;
    for (const std::string& part : parts) key.add(part);
    return key.text();
  };
  CHECK(text_of({}) == "6c62272e07bb014262b821756295c58d");
  CHECK(text_of({"ab", "c"}) != text_of({"a", "bc"}));
  // one part that holds the bytes which would stand between the two
  CHECK(text_of({"a", "b"}) != text_of({"a" + std::string(8, '\0') + "b"}));
}

}  // namespace foldproof
