#!/bin/sh
# npm, called as npm is. Where the machine has none, the one of npm's registry is fetched into
# build/npm, by checksum: Debian's npm brings 360 packages.
set -eu
command -v npm >/dev/null && exec npm "$@"
version=10.9.2
checksum=iriPEPIkoMYUy3F6f3wwSZAU93E0Eg6cHwIR6jzzOXWSy+SD/rOODEs74cVONHKSx2obXtuUoyidVEhISrisgQ==
root=$(cd "$(dirname "$0")/.." && pwd)
npm=$root/build/npm/$version
if [ ! -d "$npm" ]; then
  command -v node >/dev/null || { echo "npm.sh: no Node.js; run scripts/setup.sh web" >&2; exit 1; }
  mkdir -p "$root/build/npm"
  new=$(mktemp -d "$root/build/npm/new.XXXXXX")
  trap 'rm -rf "$new"' EXIT
  node - "${npm_config_registry:-https://registry.npmjs.org}/npm/-/npm-$version.tgz" "$checksum" "$new/npm.tgz" <<'END'
const [source, checksum, file] = process.argv.slice(2);
const fail = (why) => { console.error(`npm.sh: ${source}: ${why}`); process.exit(1); };
fetch(source).then(async (response) => {
  if (!response.ok) fail(`answer ${response.status}`);
  const bytes = Buffer.from(await response.arrayBuffer());
  if (require("crypto").createHash("sha512").update(bytes).digest("base64") !== checksum) fail("wrong checksum");
  require("fs").writeFileSync(file, bytes);
}).catch((error) => fail(error.cause?.message ?? error.message));
END
  tar -xzf "$new/npm.tgz" -C "$new"
  mv "$new/package" "$npm"
  rm -rf "$new"
  trap - EXIT
fi
exec node "$npm/bin/npm-cli.js" "$@"
