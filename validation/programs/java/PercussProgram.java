import com.google.gson.Gson;
import com.google.gson.GsonBuilder;
import com.google.gson.JsonObject;
import com.google.gson.JsonParser;
import java.io.BufferedReader;
import java.io.IOException;
import java.io.InputStreamReader;
import java.io.PrintStream;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;

/**
 * Programs that percuss runs as engines, for Java: the protocol, which docs/PROTOCOL.md describes.
 *
 * <p>A program calls {@link #serve} with what it can do and with a function that makes a run.
 */
final class PercussProgram {
    private PercussProgram() {}

    /** Makes a run to its end. */
    interface Maker {
        void make(PercussCourse course);
    }

    /** A set-up as the capabilities name it. */
    static Map<String, Object> setup(
            String name, String method, String methodClass, Integer order) {
        Map<String, Object> setup = new TreeMap<>();
        setup.put("name", name);
        setup.put("method", method);
        setup.put("class", methodClass);
        setup.put("order", order);
        setup.put("events", "library");
        setup.put("dense_output", true);
        setup.put("stepping", "adaptive");
        return setup;
    }

    /** Answers requests until there are no more. */
    static void serve(String library, String version, List<Map<String, Object>> setups, Maker maker)
            throws IOException {
        Gson gson = new GsonBuilder().serializeNulls().create();
        PrintStream answers = System.out;
        // What a library prints is no answer.
        System.setOut(System.err);
        Map<String, Object> said = Map.of(
                "library", library,
                "version", version,
                "language", "Java " + System.getProperty("java.version"),
                "setups", setups);
        BufferedReader requests = new BufferedReader(new InputStreamReader(System.in, "UTF-8"));
        for (String line; (line = requests.readLine()) != null; ) {
            JsonObject request = JsonParser.parseString(line).getAsJsonObject();
            Map<String, Object> answer = new TreeMap<>();
            answer.put("percuss_protocol", 1);
            answer.put("id", request.get("id"));
            switch (request.get("ask").getAsString()) {
                case "capabilities" -> answer.put("capabilities", said);
                case "ready" -> answer.put("ready", true);
                default -> made(gson, request, maker, answer);
            }
            answers.println(gson.toJson(answer));
            answers.flush();
        }
    }

    /** Adds a run to an answer, or why there is none. */
    private static void made(
            Gson gson, JsonObject request, Maker maker, Map<String, Object> answer) {
        try {
            PercussCourse course = new PercussCourse(gson, request.get("run"));
            long began = System.nanoTime();
            maker.make(course);
            // A number that is not finite is refused here.
            answer.put("run", gson.toJsonTree(course.answer(System.nanoTime() - began)));
        } catch (PercussCourse.GaveUp why) {
            answer.put("gave_up", why.getMessage());
        } catch (RuntimeException why) { // whatever a library throws is its reason
            answer.put("failure", why.getClass().getSimpleName() + ": " + why.getMessage());
        }
    }
}
