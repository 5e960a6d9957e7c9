// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Frame-context FIFO: each reader gets the fields that were written for its frame, with up to sixteen frames inside.
//
// The harness numbers the frames at each place by its own counters. It keeps the fields of one frame in sixteen, chosen
// freely, and compares them when a reader is at that frame.
module harness (
    input wire clock,
    input wire in_taken,
    input wire in_last,
    input wire in_dropped,
    input wire calibrated,
    input wire [31:0] in_contact,
    input wire [26:0] in_noise,
    input wire [7:0] in_version,
    input wire [3:0] in_replaced,
    input wire scaled,
    input wire [4:0] in_exponent,
    input wire [25:0] smoothed,
    input wire cean_take,
    input wire direction_take,
    input wire take
);

    (* anyconst *) reg [3:0] watched;
    reg started = 1'b0;
    wire reset = !started;
    wire [31:0] contact;
    wire [26:0] noise;
    wire [4:0] direction_exponent;
    wire [24:0] direction_variance;
    wire [31:0] timestamp;
    wire dropped;
    wire [7:0] version;
    wire [3:0] replaced;
    wire [4:0] exponent;
    wire [31:0] now;
    wire in_frame;
    wire [58:0] thresholds;
    // Of each field, in this order: where the next word goes, and where the oldest stands
    wire [4*6-1:0] newest;
    wire [4*6-1:0] oldest;
    wire [33*16-1:0] beginnings;
    wire [59*16-1:0] for_cean;
    wire [12*16-1:0] versions;
    wire [5*16-1:0] for_direction;
    wire [5*16-1:0] exponents;
    wire [25*16-1:0] variances;

    sptfra_frame_context subject (
        .clock              (clock),
        .reset              (reset),
        .in_taken           (in_taken),
        .in_last            (in_last),
        .in_dropped         (in_dropped),
        .calibrated         (calibrated),
        .in_contact         (in_contact),
        .in_noise           (in_noise),
        .in_version         (in_version),
        .in_replaced        (in_replaced),
        .scaled             (scaled),
        .in_exponent        (in_exponent),
        .smoothed           (smoothed),
        .cean_take          (cean_take),
        .contact            (contact),
        .noise              (noise),
        .direction_take     (direction_take),
        .direction_exponent (direction_exponent),
        .direction_variance (direction_variance),
        .take               (take),
        .timestamp          (timestamp),
        .dropped            (dropped),
        .version            (version),
        .replaced           (replaced),
        .exponent           (exponent),
        // Inside
        .now      (now),
        .in_frame (in_frame),
        .\gen_calibration.thresholds (thresholds),
        .\beginnings.newest_place (newest[3:0]),
        .\beginnings.oldest_place (oldest[3:0]),
        .\gen_calibration.for_cean.newest_place (newest[7:4]),
        .\gen_calibration.for_cean.oldest_place (oldest[7:4]),
        .\gen_calibration.for_output.newest_place (newest[11:8]),
        .\gen_calibration.for_output.oldest_place (oldest[11:8]),
        .\gen_scale.for_direction.newest_place (newest[15:12]),
        .\gen_scale.for_direction.oldest_place (oldest[15:12]),
        .\gen_scale.for_output.newest_place (newest[19:16]),
        .\gen_scale.for_output.oldest_place (oldest[19:16]),
        .\gen_variance.for_direction.newest_place (newest[23:20]),
        .\gen_variance.for_direction.oldest_place (oldest[23:20]),
        .\beginnings.seen (beginnings),
        .\gen_calibration.for_cean.seen (for_cean),
        .\gen_calibration.for_output.seen (versions),
        .\gen_scale.for_direction.seen (for_direction),
        .\gen_scale.for_output.seen (exponents),
        .\gen_variance.for_direction.seen (variances)
    );

    // ---- Frames that have passed each place, modulo 32
    reg [4:0] pushed;
    reg [4:0] with_calibration;
    reg [4:0] measured;
    reg [4:0] with_scale;
    reg [4:0] with_variance;
    reg [4:0] directed;
    reg [4:0] popped;
    reg open;
    reg [31:0] clock_count;
    wire begins = in_taken && !open;
    wire [4:0] inside = pushed - popped;

    // ---- Fields of the watched frame
    reg [31:0] its_timestamp;
    reg its_dropped;
    reg [31:0] its_contact;
    reg [26:0] its_noise;
    reg [7:0] its_version;
    reg [3:0] its_replaced;
    reg [4:0] its_exponent;
    reg [24:0] its_variance;
    reg [1:0] settled; // cycles since CeAn took a frame, or the next one was calibrated, at most two

    always @(posedge clock) begin
        started <= 1'b1;
        if (started) begin
            clock_count <= clock_count + 32'd1;
            if (in_taken) begin
                open <= !in_last;
            end
            pushed <= pushed + {4'd0, begins};
            with_calibration <= with_calibration + {4'd0, calibrated};
            measured <= measured + {4'd0, cean_take};
            with_scale <= with_scale + {4'd0, scaled};
            with_variance <= with_variance + {4'd0, smoothed[25]};
            directed <= directed + {4'd0, direction_take};
            popped <= popped + {4'd0, take};
            settled <= (cean_take || (calibrated && (with_calibration == measured))) ? 2'd0
                : (settled == 2'd2) ? settled : settled + 2'd1;
            if (begins && (pushed[3:0] == watched)) begin
                its_timestamp <= clock_count;
                its_dropped <= in_dropped;
            end
            if (calibrated && (with_calibration[3:0] == watched)) begin
                its_contact <= in_contact;
                its_noise <= in_noise;
                its_version <= in_version;
                its_replaced <= in_replaced;
            end
            if (scaled && (with_scale[3:0] == watched)) begin
                its_exponent <= in_exponent;
            end
            if (smoothed[25] && (with_variance[3:0] == watched)) begin
                its_variance <= smoothed[24:0];
            end
        end
        if (reset) begin
            pushed <= 5'd0;
            with_calibration <= 5'd0;
            measured <= 5'd0;
            with_scale <= 5'd0;
            with_variance <= 5'd0;
            directed <= 5'd0;
            popped <= 5'd0;
            open <= 1'b0;
            clock_count <= 32'd1;
            settled <= 2'd0;
        end
    end

    // ---- What the core keeps: a frame passes all places in their order, and no more than sixteen are inside
    always @(*) begin
        if (started) begin
            assume (!begins || take || (inside != 5'd16));
            assume (!calibrated || (with_calibration != pushed));
            assume (!cean_take || (measured != with_calibration));
            assume (!scaled || (with_scale != pushed));
            assume (!smoothed[25] || (with_variance != pushed));
            assume (!direction_take
                || ((directed != measured) && (directed != with_scale) && (directed != with_variance)));
            assume (!take || (popped != directed));
        end
    end

    // ---- A context that leaves is that of its frame
    always @(*) begin
        if (started) begin
            if (take && (popped[3:0] == watched)) begin
                assert (timestamp == its_timestamp);
                assert (dropped == its_dropped);
                assert ({version, replaced} == {its_version, its_replaced});
                assert (exponent == its_exponent);
            end
            if (direction_take && (directed[3:0] == watched)) begin
                assert (direction_exponent == its_exponent);
                assert (direction_variance == its_variance);
            end
            // The thresholds pass a register
            if ((measured != with_calibration) && (measured[3:0] == watched) && (settled != 2'd0)) begin
                assert ({contact, noise} == {its_contact, its_noise});
            end
        end
    end

`ifdef INVARIANTS
    wire [4:0] to_calibrate = pushed - with_calibration;
    wire [4:0] to_measure = with_calibration - measured;
    wire [4:0] to_scale = pushed - with_scale;
    wire [4:0] to_direct = measured - directed;
    wire [4:0] scaled_ahead = with_scale - directed;
    wire [4:0] to_smooth = pushed - with_variance;
    wire [4:0] smoothed_ahead = with_variance - directed;
    wire [4:0] to_pop = directed - popped;
    // Places of the watched frame
    wire [3:0] place = watched - popped[3:0];
    wire is_inside = ({1'b0, place} < inside);
    wire [4:0] is_calibrated = with_calibration - popped;
    wire [4:0] is_scaled = with_scale - popped;
    wire [4:0] is_smoothed = with_variance - popped;
    reg [32:0] beginning_there;
    reg [58:0] thresholds_there;
    reg [11:0] version_there;
    reg [4:0] direction_there;
    reg [4:0] exponent_there;
    reg [24:0] variance_there;
    integer frame;

    always @(*) begin
        beginning_there = 33'd0;
        thresholds_there = 59'd0;
        version_there = 12'd0;
        direction_there = 5'd0;
        exponent_there = 5'd0;
        variance_there = 25'd0;
        for (frame = 0; frame < 16; frame = frame + 1) begin
            if (watched == frame) begin
                beginning_there = beginnings[33*frame +: 33];
                thresholds_there = for_cean[59*frame +: 59];
                version_there = versions[12*frame +: 12];
                direction_there = for_direction[5*frame +: 5];
                exponent_there = exponents[5*frame +: 5];
                variance_there = variances[25*frame +: 25];
            end
        end
    end

    always @(*) begin
        if (started) begin
            assert (inside <= 5'd16);
            assert (to_calibrate <= inside);
            assert (to_measure <= inside - to_calibrate);
            assert (to_scale <= inside);
            assert (to_direct <= inside - to_calibrate - to_measure);
            assert (scaled_ahead <= inside - to_scale);
            assert (to_smooth <= inside);
            assert (smoothed_ahead <= inside - to_smooth);
            assert (to_pop == inside - to_calibrate - to_measure - to_direct);
            assert (to_pop == inside - to_scale - scaled_ahead);
            assert (to_pop == inside - to_smooth - smoothed_ahead);
            assert (in_frame == open);
            assert (now == clock_count);
            assert (newest == {with_variance[3:0], with_scale[3:0], with_scale[3:0], with_calibration[3:0],
                with_calibration[3:0], pushed[3:0]});
            assert (oldest == {directed[3:0], popped[3:0], directed[3:0], popped[3:0], measured[3:0], popped[3:0]});
            assert (!is_inside || (beginning_there == {its_dropped, its_timestamp}));
            assert (({1'b0, place} >= is_calibrated) || (thresholds_there == {its_contact, its_noise}));
            assert (({1'b0, place} >= is_calibrated) || (version_there == {its_version, its_replaced}));
            assert (({1'b0, place} >= is_scaled) || (direction_there == its_exponent));
            assert (({1'b0, place} >= is_scaled) || (exponent_there == its_exponent));
            assert (({1'b0, place} >= is_smoothed) || (variance_there == its_variance));
            assert ((measured == with_calibration) || (measured[3:0] != watched) || (settled == 2'd0)
                || (thresholds == {its_contact, its_noise}));
        end
    end
`endif

endmodule
