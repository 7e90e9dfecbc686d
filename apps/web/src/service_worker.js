// Caches the whole page for use without a network. build.mjs defines FILES and VERSION; a new version replaces the
// cache.
/* global FILES, VERSION */

const cacheName = `mien-${VERSION}`;

self.addEventListener('install', event => event.waitUntil((async () => {
  const cache = await caches.open(cacheName);
  await cache.addAll(FILES.map(file => new Request(file, {cache: 'reload'})));
  await self.skipWaiting();
})()));

self.addEventListener('activate', event => event.waitUntil((async () => {
  for (const name of await caches.keys()) {
    if (name.startsWith('mien-') && name !== cacheName) await caches.delete(name);
  }
  await self.clients.claim();
})()));

self.addEventListener('fetch', event => {
  const {method, url} = event.request;
  if (method !== 'GET' || new URL(url).origin !== location.origin) return;
  event.respondWith(caches.open(cacheName)
    .then(cache => cache.match(event.request, {ignoreSearch: true}))
    .then(kept => kept ?? fetch(event.request)));
});
