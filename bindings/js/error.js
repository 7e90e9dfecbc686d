// The error of all functions; `status` is the mien_status, if the library returned one.
export class MienError extends Error {
  constructor(message, status) {
    super(message);
    this.name = 'MienError';
    this.status = status;
  }
}
