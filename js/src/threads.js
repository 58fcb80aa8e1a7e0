// Workers of node.

/**
 * Returns node's module of threads. Its name is put together so that bundlers for browsers do not look for the module.
 */
export const nodeThreads = () =>
  import(/* webpackIgnore: true */ /* @vite-ignore */["node", "worker_threads"].join(":"));
