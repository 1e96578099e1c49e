/*
 * A shim for LD_PRELOAD that makes one call of a program fail. tests/faults/run uses it.
 *
 *   FAULT_CLASS   what fails: malloc (ENOMEM), write (ENOSPC), read (EIO), open (EMFILE),
 *                 close (EIO), rename (EIO; linkat too), thread (EAGAIN); or what must not
 *                 matter: interrupt (reads and writes end with EINTR), short (they move
 *                 fewer bytes than asked for, at least one)
 *   FAULT_AT      the how manieth call of the class fails, from 1; 0: none, only count
 *   FAULT_STICKY  1: all calls after it fail, too
 *   FAULT_REPORT  a file that gets the number of calls at the end; a fault was reached where
 *                 it is not below FAULT_AT
 *
 * Only calls after main has begun count. stdio is one of the callers: its calls inside the
 * C library cannot be seen, so the functions of stdio that the programs use count instead,
 * except on stderr. SIGALRM ends a program that does not come to its end.
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#define LONGEST_RUN_S 60 /* no run takes a second; the rest is for a busy machine */

enum class {
	CLASS_NONE,
	CLASS_MALLOC,
	CLASS_WRITE,
	CLASS_READ,
	CLASS_OPEN,
	CLASS_CLOSE,
	CLASS_RENAME,
	CLASS_THREAD,
	CLASS_INTERRUPT,
	CLASS_SHORT
};

static enum class chosen; /* CLASS_NONE before main and after it */
static long fail_at;
static int sticky;
static atomic_long calls;
static const char *report;

/* The next definition of a function behind this one, as a pointer of its type. */
#define REAL(function) ((__typeof__(function) *)find(#function))

static void *
find(const char *name)
{
	void *function = dlsym(RTLD_NEXT, name);

	if (!function)
		abort();
	return function;
}

/* Counts a call; 1 where it must fail. */
static int hit(enum class class)
{
	long number;

	if (class != chosen)
		return 0;
	number = atomic_fetch_add(&calls, 1) + 1;
	return fail_at > 0 && (number == fail_at || (sticky && number > fail_at));
}

static int
fails(enum class class, int errnum)
{
	if (!hit(class))
		return 0;
	errno = errnum;
	return 1;
}

static void
take_settings(void)
{
	static const struct {
		const char *name;
		enum class class;
	} known[] = {{"malloc", CLASS_MALLOC}, {"write", CLASS_WRITE}, {"read", CLASS_READ},
		{"open", CLASS_OPEN}, {"close", CLASS_CLOSE}, {"rename", CLASS_RENAME},
		{"thread", CLASS_THREAD}, {"interrupt", CLASS_INTERRUPT},
		{"short", CLASS_SHORT}};
	const char *name = getenv("FAULT_CLASS"), *at = getenv("FAULT_AT"),
		   *more = getenv("FAULT_STICKY");

	report = getenv("FAULT_REPORT");
	fail_at = at ? strtol(at, NULL, 10) : 0;
	sticky = more && strcmp(more, "1") == 0;
	for (size_t i = 0; name && i < sizeof known / sizeof known[0]; i++) {
		if (strcmp(name, known[i].name) == 0)
			chosen = known[i].class;
	}
}

static int (*real_main)(int, char **, char **);

static int
armed_main(int argc, char **argv, char **environment)
{
	alarm(LONGEST_RUN_S);
	take_settings();
	return real_main(argc, argv, environment);
}

/* glibc's entry: between the dynamic loader and main. */
/* NOLINTBEGIN(bugprone-reserved-identifier) */
int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv,
	void (*init)(void), void (*fini)(void), void (*loader_fini)(void), void *stack_end);

int
__libc_start_main(int (*main)(int, char **, char **), int argc, char **argv,
	void (*init)(void), void (*fini)(void), void (*loader_fini)(void), void *stack_end)
{
	real_main = main;
	return REAL(__libc_start_main)(
		armed_main, argc, argv, init, fini, loader_fini, stack_end);
}
/* NOLINTEND(bugprone-reserved-identifier) */

__attribute__((destructor)) static void
tell(void)
{
	char text[32];
	int fd, length;

	chosen = CLASS_NONE;
	fd = report ? REAL(open)(report, O_WRONLY | O_CREAT | O_TRUNC, 0600) : -1;
	if (fd < 0)
		return;
	length = snprintf(text, sizeof text, "%ld\n", atomic_load(&calls));
	(void)!REAL(write)(fd, text, (size_t)length);
	REAL(close)(fd);
}

/* Memory. A sanitizer's functions, where there are any, come behind these. */

void *
malloc(size_t size)
{
	static __typeof__(malloc) *real;

	if (!real)
		real = REAL(malloc);
	return fails(CLASS_MALLOC, ENOMEM) ? NULL : real(size);
}

void *
calloc(size_t count, size_t size)
{
	static __typeof__(calloc) *real;

	if (!real)
		real = REAL(calloc);
	return fails(CLASS_MALLOC, ENOMEM) ? NULL : real(count, size);
}

void *
realloc(void *memory, size_t size)
{
	static __typeof__(realloc) *real;

	if (!real)
		real = REAL(realloc);
	return fails(CLASS_MALLOC, ENOMEM) ? NULL : real(memory, size);
}

void *
aligned_alloc(size_t alignment, size_t size)
{
	return fails(CLASS_MALLOC, ENOMEM) ? NULL : REAL(aligned_alloc)(alignment, size);
}

int
posix_memalign(void **memory, size_t alignment, size_t size)
{
	return hit(CLASS_MALLOC) ? ENOMEM : REAL(posix_memalign)(memory, alignment, size);
}

/* Reading and writing. */

/* About a third of what was asked for, so that the rest takes more than one call. */
static size_t
portion(size_t size)
{
	return size > 1 && hit(CLASS_SHORT) ? (size + 2) / 3 : size;
}

ssize_t
read(int fd, void *data, size_t size)
{
	if (fails(CLASS_READ, EIO) || fails(CLASS_INTERRUPT, EINTR))
		return -1;
	return REAL(read)(fd, data, portion(size));
}

ssize_t
pread(int fd, void *data, size_t size, off_t offset)
{
	if (fails(CLASS_READ, EIO) || fails(CLASS_INTERRUPT, EINTR))
		return -1;
	return REAL(pread)(fd, data, portion(size), offset);
}

ssize_t
write(int fd, const void *data, size_t size)
{
	if (fails(CLASS_WRITE, ENOSPC) || fails(CLASS_INTERRUPT, EINTR))
		return -1;
	return REAL(write)(fd, data, portion(size));
}

ssize_t
pwrite(int fd, const void *data, size_t size, off_t offset)
{
	if (fails(CLASS_WRITE, ENOSPC) || fails(CLASS_INTERRUPT, EINTR))
		return -1;
	return REAL(pwrite)(fd, data, portion(size), offset);
}

/* stdio. A stream remembers that it failed. */

static int
stream_fails(FILE *stream, enum class class, int errnum)
{
	if (stream == stderr || !fails(class, errnum))
		return 0;
	stream->_flags |= _IO_ERR_SEEN;
	return 1;
}

size_t
fread(void *data, size_t size, size_t count, FILE *stream)
{
	return stream_fails(stream, CLASS_READ, EIO)
		       ? 0
		       : REAL(fread)(data, size, count, stream);
}

size_t
fwrite(const void *data, size_t size, size_t count, FILE *stream)
{
	return stream_fails(stream, CLASS_WRITE, ENOSPC)
		       ? 0
		       : REAL(fwrite)(data, size, count, stream);
}

int
fputs(const char *text, FILE *stream)
{
	return stream_fails(stream, CLASS_WRITE, ENOSPC) ? EOF : REAL(fputs)(text, stream);
}

int
fputc(int byte, FILE *stream)
{
	return stream_fails(stream, CLASS_WRITE, ENOSPC) ? EOF : REAL(fputc)(byte, stream);
}

int
puts(const char *text)
{
	return stream_fails(stdout, CLASS_WRITE, ENOSPC) ? EOF : REAL(puts)(text);
}

int
putchar(int byte)
{
	return stream_fails(stdout, CLASS_WRITE, ENOSPC) ? EOF : REAL(putchar)(byte);
}

int
printf(const char *format, ...)
{
	va_list arguments;
	int result;

	if (stream_fails(stdout, CLASS_WRITE, ENOSPC))
		return -1;
	va_start(arguments, format);
	result = vfprintf(stdout, format, arguments);
	va_end(arguments);
	return result;
}

int
fprintf(FILE *stream, const char *format, ...)
{
	va_list arguments;
	int result;

	if (stream_fails(stream, CLASS_WRITE, ENOSPC))
		return -1;
	va_start(arguments, format);
	result = vfprintf(stream, format, arguments);
	va_end(arguments);
	return result;
}

int
fflush(FILE *stream)
{
	if (stream && stream_fails(stream, CLASS_WRITE, ENOSPC))
		return EOF;
	return REAL(fflush)(stream);
}

/* Files. */

int
open(const char *path, int flags, ...)
{
	va_list arguments;
	mode_t mode;

	va_start(arguments, flags);
	mode = flags & (O_CREAT | __O_TMPFILE) ? va_arg(arguments, mode_t) : 0;
	va_end(arguments);
	return fails(CLASS_OPEN, EMFILE) ? -1 : REAL(open)(path, flags, mode);
}

int
mkostemp(char *name, int flags)
{
	return fails(CLASS_OPEN, EMFILE) ? -1 : REAL(mkostemp)(name, flags);
}

FILE *
fopen(const char *path, const char *mode)
{
	return fails(CLASS_OPEN, EMFILE) ? NULL : REAL(fopen)(path, mode);
}

/* The descriptor is gone all the same, as with the system's own errors. */
int
close(int fd)
{
	int result = REAL(close)(fd);

	return fails(CLASS_CLOSE, EIO) ? -1 : result;
}

int
fclose(FILE *stream)
{
	int result = REAL(fclose)(stream);

	return fails(CLASS_CLOSE, EIO) ? EOF : result;
}

int
rename(const char *from, const char *to)
{
	return fails(CLASS_RENAME, EIO) ? -1 : REAL(rename)(from, to);
}

int
linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
	return fails(CLASS_RENAME, EIO)
		       ? -1
		       : REAL(linkat)(from_folder, from, to_folder, to, flags);
}

/* Threads. */

int
pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
	void *argument)
{
	return hit(CLASS_THREAD)
		       ? EAGAIN
		       : REAL(pthread_create)(thread, attributes, start, argument);
}
