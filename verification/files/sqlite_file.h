// The door to SQLite: a database file, and prepared statements.
#pragma once

#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace foldproof {

/// A prepared statement. Values are bound in the order of its question marks; columns are counted
/// from 0. All throw std::runtime_error naming the database and saying why.
class SqliteQuery {
 public:
  SqliteQuery(sqlite3* database, const std::string& path, const std::string& sql);

  SqliteQuery& bind(const std::string& text);
  SqliteQuery& bind(double number);
  SqliteQuery& bind(long number);

  /// The next row; false after the last one, when the statement is ready to be bound anew.
  bool next();

  /// For a statement without rows: runs it, ready to be bound anew.
  void run() {
    while (next()) continue;
  }

  /// Forgets the rest of the rows.
  void reset();

  std::string text(int column) const;
  double number(int column) const;  // NaN for null
  long whole(int column) const;

 private:
  std::string path_;
  std::shared_ptr<sqlite3_stmt> statement_;
  int bound_ = 0;
};

class SqliteFile {
 public:
  /// Opens or creates the file. Throws std::runtime_error if it cannot be opened, or
  /// is no database.
  explicit SqliteFile(const std::string& path);

  /// Runs statements without results.
  void run(const std::string& sql);

  /// Ends a transaction without its changes. SQLite does so itself where the disk is full, and then
  /// this does nothing.
  void roll_back();

  SqliteQuery query(const std::string& sql);

  /// Rows that the last statement inserted, changed or deleted.
  long changes() const;

 private:
  std::string path_;
  std::shared_ptr<sqlite3> database_;
};

}  // namespace foldproof
