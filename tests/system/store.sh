#!/bin/sh
# Signing and the store, from a maker's key to a dealer's rollback, with Debian's minisign on both sides.
# Usage: store.sh PATH_TO_LACKWERK
set -eu
lackwerk=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
if ! minisign -v >/dev/null 2>&1; then
  echo 'SKIPPED: no minisign; install the package minisign'
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0
checks=0

# is CODE PATTERN COMMAND...: exit code, and a basic regular expression for what it prints on both.
is() {
  code=$1 pattern=$2
  shift 2
  checks=$((checks + 1))
  status=0
  "$@" >out.txt 2>&1 || status=$?
  if [ "$status" -eq "$code" ] && grep -q "$pattern" out.txt; then return 0; fi
  echo "FAILED: $*: exit code $status, expected $code with '$pattern':"
  cat out.txt
  failures=$((failures + 1))
}

cp "$here/small.toml" .
"$lackwerk" capture small.toml -o capture --edge 16 --texel-mm 0.05
for serial in 1 2 3; do "$lackwerk" pack build capture -o "summer-$serial.lwp" --id summer --serial "$serial" >/dev/null; done
mkdir keys strangers
minisign -G -W -p keys/maker.pub -s maker.key >/dev/null
minisign -G -W -p strangers/other.pub -s other.key >/dev/null
id=$(tail -n 1 keys/maker.pub)

# Signing, both ways.
is 0 'id=summer serial=1' "$lackwerk" pack sign summer-1.lwp --secret maker.key
is 0 'id=summer serial=1' minisign -V -p keys/maker.pub -m summer-1.lwp
minisign -S -s maker.key -m summer-2.lwp -t 'id=summer serial=2' >/dev/null
is 0 'signed as summer 2' "$lackwerk" pack verify summer-2.lwp --key keys/maker.pub
is 0 'signed as summer 2' "$lackwerk" pack verify summer-2.lwp --key "$id"
is 0 '"signed":true' "$lackwerk" pack verify summer-2.lwp --keyring keys --json
is 1 'not in the keyring' "$lackwerk" pack verify summer-2.lwp --keyring strangers
is 1 'not signed' "$lackwerk" pack verify summer-3.lwp --key keys/maker.pub
is 2 'exclude' "$lackwerk" pack verify summer-2.lwp --key keys/maker.pub --keyring keys
minisign -S -l -s maker.key -m summer-3.lwp -t 'id=summer serial=3' >/dev/null
is 1 'legacy' "$lackwerk" pack verify summer-3.lwp --key keys/maker.pub
is 1 'no minisign secret key' "$lackwerk" pack sign summer-3.lwp --secret keys/maker.pub
is 1 'digest\|magic\|pack' "$lackwerk" pack sign small.toml --secret maker.key
printf 'a word\na word\n' | minisign -G -p keys/locked.pub -s locked.key >/dev/null 2>&1
is 1 'password is wrong' sh -c "echo another | '$lackwerk' pack sign summer-3.lwp --secret locked.key"
is 0 'id=summer serial=3' sh -c "echo 'a word' | '$lackwerk' pack sign summer-3.lwp --secret locked.key"
is 0 'id=summer serial=3' minisign -V -p keys/locked.pub -m summer-3.lwp

# The store.
store="--root store"
is 0 'is empty' "$lackwerk" store list $store
is 0 'summer 2 is in use' "$lackwerk" store add $store --keyring keys summer-2.lwp
is 0 'already' "$lackwerk" store add $store --keyring keys summer-2.lwp
is 1 'not above 2' "$lackwerk" store add $store --keyring keys summer-1.lwp
is 0 'summer 3 is in use' "$lackwerk" store add $store --keyring keys summer-3.lwp
is 0 'summer 3, before it 2, shown' "$lackwerk" store list $store
is 0 '"previous_serial":2' "$lackwerk" store list $store --json
is 0 'back at 2' "$lackwerk" store rollback $store summer
is 1 'no version before' "$lackwerk" store rollback $store summer
is 0 'signed as summer 2' "$lackwerk" pack verify store/packs/summer/*/pack.lwp --keyring keys
is 1 'no such pack' "$lackwerk" store rollback $store winter
is 1 'no such pack' "$lackwerk" store remove $store winter
# A key that is revoked counts from the next pack on.
sed -n 's/.*public key \([0-9A-F]*\)$/\1/p' keys/locked.pub >keys/revoked
is 1 'revoked' "$lackwerk" store add $store --keyring keys summer-3.lwp
rm keys/revoked
is 0 'summer 3 is in use' "$lackwerk" store add $store --keyring keys summer-3.lwp
is 0 'removed' "$lackwerk" store remove $store summer
is 0 'is empty' "$lackwerk" store list $store
test -z "$(find store -name '*.lwp')" || { echo 'FAILED: remove left packs'; failures=$((failures + 1)); }
is 1 'not signed' "$lackwerk" store add $store --keyring keys capture/../summer-1.lwp.minisig
cp summer-1.lwp bare.lwp
is 1 'not signed' "$lackwerk" store add $store --keyring keys bare.lwp
is 0 'unsigned' "$lackwerk" store add $store --keyring nowhere --allow-unsigned bare.lwp
ln -s summer-3.lwp link.lwp
ln -s summer-3.lwp.minisig link.lwp.minisig
is 1 'link.lwp' "$lackwerk" store add $store --keyring keys link.lwp
head -c 2000000 /dev/zero >big.lwp
is 1 'do not fit' "$lackwerk" store add $store --quota-mb 1 --keyring keys --allow-unsigned big.lwp
# The root cannot be written, not even by root.
is 1 'proc' "$lackwerk" store add --root /proc/lackwerk --keyring keys summer-3.lwp
for command in '' add list remove rollback; do
  # shellcheck disable=SC2086
  is 0 'Usage' "$lackwerk" store $command --help
done

echo "$checks checks, $failures failures"
test "$failures" -eq 0
