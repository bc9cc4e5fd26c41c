#include "verification/files/sqlite_file.h"

#include <sqlite3.h>

#include <limits>
#include <stdexcept>

namespace foldproof {

namespace {

constexpr int patience = 120'000;  // for another writer [ms]

[[noreturn]] void fail(const std::string& path, sqlite3* database) {
  throw std::runtime_error(path + ": " + sqlite3_errmsg(database));
}

}  // namespace

SqliteQuery::SqliteQuery(sqlite3* database, const std::string& path, const std::string& sql)
    : path_(path) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
    fail(path, database);
  statement_.reset(statement, sqlite3_finalize);
}

void SqliteQuery::require_bound(int result) const {
  if (result != SQLITE_OK) fail(path_, sqlite3_db_handle(statement_.get()));
}

void SqliteQuery::bind_one(const std::string& text) {
  require_bound(sqlite3_bind_text(statement_.get(), ++bound_, text.data(), int(text.size()),
                                  SQLITE_TRANSIENT));
}

void SqliteQuery::bind_one(double number) {
  require_bound(sqlite3_bind_double(statement_.get(), ++bound_, number));
}

void SqliteQuery::bind_one(long number) {
  require_bound(sqlite3_bind_int64(statement_.get(), ++bound_, number));
}

void SqliteQuery::reset() {
  sqlite3_reset(statement_.get());
  bound_ = 0;
}

bool SqliteQuery::next() {
  const int result = sqlite3_step(statement_.get());
  if (result == SQLITE_ROW) return true;
  const std::string why = sqlite3_errmsg(sqlite3_db_handle(statement_.get()));
  reset();
  if (result != SQLITE_DONE) throw std::runtime_error(path_ + ": " + why);
  return false;
}

std::string SqliteQuery::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return text ? std::string(text, size_t(sqlite3_column_bytes(statement_.get(), column))) : "";
}

double SqliteQuery::number(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL)
    return std::numeric_limits<double>::quiet_NaN();
  return sqlite3_column_double(statement_.get(), column);
}

long SqliteQuery::whole(int column) const { return sqlite3_column_int64(statement_.get(), column); }

SqliteFile::SqliteFile(const std::string& path) : path_(path) {
  sqlite3* database = nullptr;
  const int result = sqlite3_open(path.c_str(), &database);
  database_.reset(database, sqlite3_close_v2);
  if (result != SQLITE_OK) fail(path, database);
  sqlite3_busy_timeout(database, patience);
  run("pragma cache_size = -200000; pragma synchronous = normal; select count(*) from "
      "sqlite_master");
}

void SqliteFile::run(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail(path_, database_.get());
}

void SqliteFile::roll_back() {
  const bool is_open = sqlite3_get_autocommit(database_.get()) == 0;
  if (is_open) run("rollback");
}

SqliteQuery SqliteFile::query(const std::string& sql) { return {database_.get(), path_, sql}; }

long SqliteFile::changes() const { return sqlite3_changes(database_.get()); }

}  // namespace foldproof
