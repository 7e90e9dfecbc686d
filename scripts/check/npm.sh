# shellcheck shell=bash
# Sourced in the repository's root. Installs the npm tools of the checks by the hashes of package-lock.json.
# Fails when there is no npm or no registry.
install_check_tools() {
  command -v npm >/dev/null || return 1
  [ scripts/check/npm/node_modules/.package-lock.json -nt scripts/check/npm/package-lock.json ] ||
    (cd scripts/check/npm && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2)
}
