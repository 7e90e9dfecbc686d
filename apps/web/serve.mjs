// Serves a folder to this machine: node serve.mjs FOLDER [PORT]
import {createReadStream} from 'node:fs';
import {stat} from 'node:fs/promises';
import {createServer} from 'node:http';
import {extname, join, resolve, sep} from 'node:path';
import {pathToFileURL} from 'node:url';

const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.mjs': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8', '.wasm': 'application/wasm', '.json': 'application/json', '.svg': 'image/svg+xml',
  '.png': 'image/png', '.webmanifest': 'application/manifest+json', '.mp4': 'video/mp4', '.wav': 'audio/wav',
  '.csv': 'text/csv; charset=utf-8', '.glb': 'model/gltf-binary'};

async function fileOf(root, url) {
  const path = decodeURIComponent(new URL(url, 'http://localhost').pathname);
  const file = resolve(join(root, path.endsWith('/') ? path + 'index.html' : path));
  if (!file.startsWith(root + sep)) return null;
  const info = await stat(file).catch(() => null);
  return info?.isFile() ? {file, bytes: info.size} : null;
}

// Returns {server, url}; port 0 selects a free port.
export async function serve(folder, port = 0) {
  const root = resolve(folder);
  const server = createServer(async (request, response) => {
    const found = await fileOf(root, request.url).catch(() => null);
    if (!found || !['GET', 'HEAD'].includes(request.method)) return response.writeHead(404).end('not found\n');
    response.writeHead(200, {
      'Content-Type': types[extname(found.file)] ?? 'application/octet-stream', 'Content-Length': found.bytes,
      'Cache-Control': 'no-cache', 'X-Content-Type-Options': 'nosniff'});
    if (request.method === 'HEAD') return response.end();
    createReadStream(found.file).pipe(response);
  });
  await new Promise((done, failed) => server.once('error', failed).listen(port, '127.0.0.1', done));
  return {server, url: `http://localhost:${server.address().port}/`};
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const {url} = await serve(process.argv[2] ?? 'dist', Number(process.argv[3] ?? 8000));
  console.log(`serving on ${url} (Ctrl+C ends it)`);
}
