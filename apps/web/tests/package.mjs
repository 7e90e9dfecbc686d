// The npm package as users install it. MIEN_WASM names another module.
import {execFileSync} from 'node:child_process';
import {cpSync} from 'node:fs';
import {join} from 'node:path';

export const root = new URL('../../..', import.meta.url).pathname;

// Returns the path of the package, which is made in an empty folder.
export function pack(folder) {
  const copy = (from, to) => cpSync(join(root, from), join(folder, to), {recursive: true});
  copy('bindings/js', '.');
  copy('models', 'models');
  copy('LICENSE', 'LICENSE');
  cpSync(process.env.MIEN_WASM ?? join(root, 'build/wasm/tracker/mien.wasm'), join(folder, 'mien.wasm'));
  return join(folder, execFileSync('npm', ['pack', '--silent'], {cwd: folder, encoding: 'utf8'}).trim());
}
