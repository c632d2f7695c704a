# What the tests of the command share, to be sourced; $lodemark is the program under test, and the
# current folder is the test's own.

failures=0

fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# expect EXIT PATTERN COMMAND...: the exit code, and a pattern that the output (both streams) holds;
# of a failure the message is short and names lodemark.
expect() {
  local code=$1 pattern=$2
  shift 2
  local limit=(timeout 60)
  [ "$(type -t "$1")" != function ] || limit=()
  "${limit[@]}" "$@" >out 2>err </dev/null
  local got=$?
  [ "$got" = "$code" ] || fail "$* gave exit code $got, not $code: $(cat err)"
  cat out err | grep -qE -- "$pattern" || fail "$* did not say '$pattern' but: $(cat out err | head -5)"
  if [ "$code" != 0 ]; then
    grep -q '^lodemark: ' err || grep -q ' ' out || fail "$* failed without a message"
    [ "$(wc -l <err)" -le 3 ] || fail "$* gave more than a sentence or two: $(head -5 err)"
  fi
}

# A file that may not be read: expect as above, but never as root, who may read everything.
expect_without_permission() {
  local file=$1
  shift
  chmod 000 "$file"
  if [ "$(id -u)" != 0 ]; then
    expect 2 'ermission' "$@"
  elif setpriv --reuid=65534 --regid=65534 --clear-groups "$lodemark" --version >/dev/null 2>&1; then
    chmod 755 .
    expect 2 'ermission' setpriv --reuid=65534 --regid=65534 --clear-groups "$@"
  fi
  chmod 644 "$file"
}

# Files that are of no use to anybody, and a line to expect of each.
make_bad_files() {
  : >empty
  head -c 4096 /dev/urandom >binary
  mkdir -p folder
  echo 'just some words' >words
  gzip -c "$lodemark" | head -c 20000 >cut.gz
}
