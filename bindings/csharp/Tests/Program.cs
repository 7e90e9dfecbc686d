using System;
using System.Linq;
using System.Reflection;

/// <summary>Runs every public method of the tests, by reflection, so that tests need only the runtime.</summary>
static class Program
{
    static int Main()
    {
        int failed = 0, passed = 0;
        foreach (Type tests in new[] { typeof(HeaderTest), typeof(BlendShapesTest), typeof(ClipTest) })
        {
            object instance = Activator.CreateInstance(tests);
            foreach (MethodInfo test in tests.GetMethods(BindingFlags.Public | BindingFlags.Instance | BindingFlags.DeclaredOnly))
            {
                try
                {
                    test.Invoke(instance, null);
                    ++passed;
                }
                catch (TargetInvocationException error)
                {
                    Console.WriteLine("FAILED " + tests.Name + "." + test.Name + ": " + error.InnerException);
                    ++failed;
                }
            }
        }
        Console.WriteLine(passed + " passed, " + failed + " failed");
        return failed == 0 ? 0 : 1;
    }
}

static class Assert
{
    public static void That(bool condition, string what)
    {
        if (!condition) throw new Exception(what);
    }

    public static void Equal<T>(T expected, T actual)
    {
        That(object.Equals(expected, actual), "expected " + expected + ", not " + actual);
    }

    public static void Near(float[] expected, float[] actual, float bound)
    {
        float most = expected.Zip(actual, (a, b) => Math.Abs(a - b)).Max();
        That(expected.Length == actual.Length && most <= bound, "off by " + most);
    }

    public static E Throws<E>(Action action) where E : Exception
    {
        try
        {
            action();
        }
        catch (E error)
        {
            return error;
        }
        throw new Exception("nothing was thrown (expected " + typeof(E).Name + ")");
    }

    public static void Refuses(Mien.Status status, Action action)
    {
        var error = Throws<Mien.MienException>(action);
        Equal(status, error.Status);
        That(error.Message.Length > 0 && error.Message != "unknown status", "a text");
    }
}
