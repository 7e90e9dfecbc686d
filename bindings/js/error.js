// What every function throws; `status` is the mien_status of mien.h, where there is one.
export class MienError extends Error {
  constructor(message, status) {
    super(message);
    this.name = 'MienError';
    this.status = status;
  }
}
