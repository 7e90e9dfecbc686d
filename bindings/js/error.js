// The error of all functions; `status` is the mien_status of mien.h, if the error has one.
export class MienError extends Error {
  constructor(message, status) {
    super(message);
    this.name = 'MienError';
    this.status = status;
  }
}
