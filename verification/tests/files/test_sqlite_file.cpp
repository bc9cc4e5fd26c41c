// The door to SQLite: values go through it unchanged, and failures say where and why.
#include <catch2/catch.hpp>
#include <cmath>
#include <chrono>
#include <limits>
#include <thread>

#include "verification/files/sqlite_file.h"
#include "verification/specimens/scratch_folder.h"

namespace foldproof {

namespace {

using Catch::Matchers::Contains;

/// A database with a table of three rows.
struct Database {
  ScratchFolder scratch;
  std::string path = scratch.file("a.sqlite");
  SqliteFile file{path};

  Database() {
    file.run(
        "create table t(name text, length real, count integer);insert into t values('a', 0.25, 7), "
        "('b', 3.5, 9), ('c', null, -3)");
  }
  long count() {
    SqliteQuery query = file.query("select count(*) from t");
    return query.next() ? query.whole(0) : -1;
  }
};

}  // namespace

TEST_CASE("sqlite: rows are read in their order, column by column") {
  Database d;
  SqliteQuery query = d.file.query("select name, length, count from t order by name");
  REQUIRE(query.next());
  CHECK((query.text(0) == "a" && query.number(1) == 0.25 && query.whole(2) == 7));
  REQUIRE(query.next());
  CHECK((query.text(0) == "b" && query.number(1) == 3.5 && query.whole(2) == 9));
  REQUIRE(query.next());
  CHECK((query.text(0) == "c" && std::isnan(query.number(1)) && query.whole(2) == -3));
  CHECK(query.text(1) == "");
  CHECK_FALSE(query.next());
}

TEST_CASE("sqlite: values are bound in the order of the question marks, and kept as they are") {
  Database d;
  const std::string text("zero \0 and \u00e9 '", 15);
  const long large = std::numeric_limits<long>::min() + 1;
  d.file.query("insert into t values(?, ?, ?)").bind(text).bind(1.0 / 3).bind(large).run();
  CHECK(d.file.changes() == 1);
  SqliteQuery query =
      d.file.query("select name, length, count from t where count = ? and name = ?");
  query.bind(large).bind(text);
  REQUIRE(query.next());
  CHECK(query.text(0) == text);
  CHECK(query.number(1) == 1.0 / 3);
  CHECK(query.whole(2) == large);
}

TEST_CASE("sqlite: a statement can be used again after its last row, and after a reset") {
  Database d;
  SqliteQuery query = d.file.query("select count from t where name = ? or name = ? order by name");
  query.bind("a").bind("b");
  REQUIRE(query.next());
  CHECK(query.whole(0) == 7);
  query.reset();
  query.bind("b").bind("c");
  REQUIRE(query.next());
  CHECK(query.whole(0) == 9);
  REQUIRE(query.next());
  CHECK(query.whole(0) == -3);
  CHECK_FALSE(query.next());
  query.bind("c").bind("none");
  REQUIRE(query.next());
  CHECK(query.whole(0) == -3);
  CHECK_FALSE(query.next());
  SqliteQuery add = d.file.query("insert into t values(?, 0.5, 1)");
  for (const char* name : {"d", "e"}) add.bind(name).run();
  CHECK(d.count() == 5);
}

TEST_CASE("sqlite: run goes through all rows") {
  Database d;
  SqliteQuery query = d.file.query("update t set count = 2 where count > ? returning name");
  query.bind(5L).run();
  CHECK(d.file.changes() == 2);
  query.bind(1L).run();
  CHECK(d.file.changes() == 2);
}

TEST_CASE("sqlite: a writer waits for another one") {
  Database d;
  d.file.run("begin immediate");
  {
    const std::jthread other([&] {
      SqliteFile file(d.path);
      file.run("insert into t values('d', 4.5, 8)");
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    d.file.run("commit");
  }
  CHECK(d.count() == 4);
}

TEST_CASE("sqlite: changes are counted of the last statement") {
  Database d;
  CHECK(d.file.changes() == 3);
  d.file.run("delete from t where count > 0");
  CHECK(d.file.changes() == 2);
  d.file.run("update t set count = 5 where name = 'none'");
  CHECK(d.file.changes() == 0);
}

TEST_CASE("sqlite: a transaction is rolled back, and without one nothing happens") {
  Database d;
  CHECK_NOTHROW(d.file.roll_back());
  d.file.run("begin; delete from t");
  CHECK(d.count() == 0);
  d.file.roll_back();
  CHECK(d.count() == 3);
  CHECK_NOTHROW(d.file.roll_back());
  d.file.run("begin; delete from t; commit");
  d.file.roll_back();
  CHECK(d.count() == 0);
}

TEST_CASE("sqlite: what is wrong is said with the name of the database") {
  Database d;
  CHECK_THROWS_WITH(d.file.query("select nonsense from t"), d.path + ": no such column: nonsense");
  CHECK_THROWS_WITH(d.file.run("insert into u values(1)"), d.path + ": no such table: u");
  SqliteQuery one = d.file.query("select name from t where count = ?");
  one.bind(7L);
  CHECK_THROWS_WITH(one.bind(8L), Contains(d.path + ": ") && Contains("out of range"));
  CHECK_THROWS_WITH(one.bind(8.5), Contains(d.path + ": ") && Contains("out of range"));
  CHECK_THROWS_WITH(one.bind("x"), Contains(d.path + ": ") && Contains("out of range"));
  d.file.run("create table once(k integer unique); insert into once values(7)");
  SqliteQuery twice = d.file.query("insert into once values(?)");
  CHECK_THROWS_WITH(twice.bind(7L).run(), d.path + ": UNIQUE constraint failed: once.k");
  CHECK_NOTHROW(twice.bind(8L).run());
}

TEST_CASE("sqlite: what is no database, or cannot be made, is refused by its name") {
  const ScratchFolder scratch;
  const std::string other = scratch.write("other", std::string(5000, 'x'));
  CHECK_THROWS_WITH(SqliteFile(other), other + ": file is not a database");
  const std::string none = scratch.file("none/a.sqlite");
  CHECK_THROWS_WITH(SqliteFile(none), none + ": unable to open database file");
}

}  // namespace foldproof
