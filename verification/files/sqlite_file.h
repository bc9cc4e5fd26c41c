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

  template <class... Values>
  SqliteQuery& bind(const Values&... values) {
    (bind_one(values), ...);
    return *this;
  }

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
  void bind_one(const std::string& text);
  void bind_one(double number);
  void bind_one(long number);
  void require_bound(int result) const;

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

  /// Ends a transaction, if there is one, without its changes. SQLite does so itself where the disk
  /// is full.
  void roll_back();

  SqliteQuery query(const std::string& sql);

  /// Rows that the last statement inserted, changed or deleted.
  long changes() const;

 private:
  std::string path_;
  std::shared_ptr<sqlite3> database_;
};

/// What is changed while it lives is kept by commit(), and else undone.
class SqliteTransaction {
 public:
  /// begin: the statement, as "begin" for a transaction that only reads at first.
  SqliteTransaction(SqliteFile& file, const std::string& begin) : file_(file) { file.run(begin); }
  /// Where the disk lets nothing be undone now, SQLite undoes it when the file is opened next.
  ~SqliteTransaction() {
    try {
      file_.roll_back();
    } catch (const std::exception&) {
    }
  }
  SqliteTransaction(const SqliteTransaction&) = delete;
  SqliteTransaction& operator=(const SqliteTransaction&) = delete;

  void commit() { file_.run("commit"); }

 private:
  SqliteFile& file_;
};

}  // namespace foldproof
