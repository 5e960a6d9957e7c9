// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Grid search estimator: friction pair (mu_x, mu_y) from the level set of Condition 1.
//
// Three stages, each with its own frame (sptfra_joint_stages): search, feature window (with NETWORK) and correction.
// u_q of the next frame may arrive meanwhile.
//
// Latency of the stages: EXPECTED_SEARCH_LATENCY, EXPECTED_FEATURES_LATENCY, and 11 cycles (with NETWORK), those of the
// network and of the friction. Interval: that of the longest stage.

`default_nettype none

module sptfra_estimator_joint #(
    // Taxels along x and y
    parameter integer COLUMNS = 10,
    parameter integer ROWS = 10,
    // Taxels that arrive at a time: 4, the images of an orbit
    parameter integer CHANNELS = 4,
    // Bits of u_q
    parameter integer DATA_BITS = 27,
    // Points of the grid evaluated at a time: all 169, or a row of 13
    parameter integer PARALLEL = 169,
    // Taxels a cycle in the search: 1, or 2 with all points at a time
    parameter integer TAXELS = 1,
    // Bits of a value of the search below the leading bit of sum |b|
    parameter integer FRACTION = 21,
    // Left shift of u before the right shift by the bits of sum |b|
    parameter integer U_LEFT = 22,
    // c1 and c3 of the friction, with 22 and 15 fraction bits
    parameter signed [26:0] LINEAR = 27'sd4194304,
    parameter signed [17:0] CUBIC = 18'sd0,
    // 1: with a standard error, and its constants: see sptfra_standard_error
    parameter integer WITH_ERROR = 0,
    parameter [17:0] ERROR_MODEL = 18'd0,
    parameter [16:0] ERROR_NOISE = 17'd0,
    parameter [16:0] ERROR_BORDER = 17'd0,
    parameter [22:0] ERROR_LARGEST = 23'd0,
    parameter integer ERROR_AVERAGED = 0,
    // 1: with a correction; the parameters from here to ROM_NAME are its own
    parameter integer NETWORK = 0,
    // Taxels on either side of the window's middle
    parameter integer HALF_X = 4,
    parameter integer HALF_Y = 4,
    // Words of inputs, passes over them, and hidden units in each
    parameter integer LENGTH = 27,
    parameter integer PASSES = 4,
    parameter integer AT_ONCE = 4,
    // Left shift of a stress times the reciprocal of sum |b|; bits dropped from a unit's sums, and from the output's
    parameter integer STRESS_LEFT = 9,
    parameter integer UNIT_SHIFT = 12,
    parameter integer CORRECTION_SHIFT = 12,
    // Prefix of the ROM file names, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Name of the ROM files, without what they hold
    parameter ROM_NAME = "",
    // Checked in simulation, 0: unchecked: cycles from the start to the first row of points
    parameter integer EXPECTED_VALUES_LATENCY = 0,
    // ... to the centroid
    parameter integer EXPECTED_SEARCH_LATENCY = 0,
    // ... from the centroid to the contact's centre
    parameter integer EXPECTED_FEATURES_LATENCY = 0,
    // ... from the first input of the network to the correction
    parameter integer EXPECTED_NETWORK_LATENCY = 0,
    // ... from the centroid, or the correction, to the friction
    parameter integer EXPECTED_FRICTION_LATENCY = 0,
    // Derived: orbits, and the bits of their number
    parameter integer ORBITS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter integer ROW_WIDTH = (ORBITS > 8) ? $clog2(ORBITS) : 3
) (
    input  wire clock,
    input  wire reset,
    // u_q of a frame, channel 0 in the lowest bits
    input  wire [2:0] u_valid, // q, one-hot
    input  wire [ROW_WIDTH-1:0] u_row,
    input  wire [CHANNELS*DATA_BITS-1:0] u_values,
    input  wire u_complete, // one cycle, with the last ones
    // From Co, held until taken
    input  wire sums_complete,
    output wire sums_take,
    input  wire [18*40-1:0] sums_in,
    // From CeAn, held until taken
    input  wire direction_valid,
    output wire direction_take,
    input  wire signed [26:0] direction_x,
    input  wire signed [26:0] direction_y,
    input  wire no_direction,
    input  wire [39:0] stress_sum,
    input  wire [26:0] largest,
    input  wire [39:0] border,
    input  wire [24:0] variance,
    input  wire [4:0] exponent,
    input  wire [5:0] flags_in, // no tension, too much replaced, no contact, saturated, NaN or infinity, bad length
    // One cycle: the place of a frame's u_q is free
    output wire u_released,
    // The answer, held until taken, the sums for a cycle more
    output wire answer_valid,
    input  wire answer_take, // only with answer_valid
    output wire x_is_free, // the free component is mu_x
    output wire signed [17:0] free, // mu_x, 16 fraction bits
    output wire signed [17:0] other, // mu_y
    output wire signed [17:0] slope, // none
    output wire signed [17:0] error_log, // of base 2, of the error of (F_x, F_y) over |F_z|, 12 fraction bits
    output reg  unknown,
    output wire at_bound,
    output wire saturated,
    output reg  [18*40-1:0] sums,
    output reg  [5:0] flags
);

    if (CHANNELS != 4) begin : gen_check
        sptfra_error_the_joint_estimator_needs_four_channels invalid ();
    end

    // ---- Stages: which frame is where
    wire fill_bank, search_bank; // of u_q
    wire search_start, features_start, correction_start;
    wire level_done, centre_done, window_done, search_done; // the last of these: the answer is there

    assign sums_take = search_start;
    assign direction_take = search_start;

    sptfra_joint_stages #(
        .FEATURES (NETWORK)
    ) stages (
        .clock            (clock),
        .reset            (reset),
        .u_complete       (u_complete),
        .sums_complete    (sums_complete),
        .contact_valid    (direction_valid),
        .search_done      (level_done),
        .features_done    (centre_done),
        .window_done      (window_done),
        .correction_done  (search_done),
        .answer_take      (answer_take),
        .search_start     (search_start),
        .features_start   (features_start),
        .correction_start (correction_start),
        .answer_valid     (answer_valid),
        .u_released       (u_released),
        .fill_bank        (fill_bank),
        .search_bank      (search_bank)
    );

    // ---- What goes with a frame from stage to stage
    reg [39:0] search_stress_sum;
    reg [26:0] search_largest;
    reg [18*40-1:0] search_sums;
    reg [5:0] search_flags;
    wire signed [17:0] found_x, found_y;
    wire found_unknown, found_on_border, found_saturated, features_saturated;
    localparam integer WITH_FOUND = 2 * 18 + 3; // what the search found
    localparam integer WITH_FRAME = 18 * 40 + 6 + 18 + WITH_FOUND;
    wire signed [17:0] found_error;
    wire [WITH_FRAME-1:0] searched = {search_sums, search_flags, found_error, found_x, found_y, found_unknown,
        found_on_border, found_saturated};
    wire [WITH_FRAME-1:0] seen; // of the frame in the features, or that was searched
    reg signed [17:0] centroid_x, centroid_y;
    reg on_border, before_saturated; // a value of search or features was clipped
    reg correction_started;
    reg signed [17:0] frame_error;
    wire signed [17:0] features_x = seen[WITH_FOUND-18 +: 18], features_y = seen[WITH_FOUND-36 +: 18];

    always @(posedge clock) begin
        if (search_start) begin
            search_sums <= sums_in;
            search_stress_sum <= stress_sum;
            search_largest <= largest;
            search_flags <= flags_in;
        end
        if (correction_start) begin
            {centroid_x, centroid_y, unknown, on_border, before_saturated} <= seen[WITH_FOUND-1:0]
                | { {(WITH_FOUND - 1){1'b0}}, features_saturated};
        end
        // What was seen stays for a cycle more, and the answer comes twenty later or more
        correction_started <= correction_start;
        if (correction_started) begin
            {sums, flags, frame_error} <= seen[WITH_FRAME-1:WITH_FOUND];
        end
    end

    // ---- Search
    wire read_valid;
    wire [ROW_WIDTH-1:0] read_orbit;
    wire [3*4*27-1:0] read_values;

    sptfra_grid_search #(
        .COLUMNS                 (COLUMNS),
        .ROWS                    (ROWS),
        .DATA_BITS               (DATA_BITS),
        .ROW_WIDTH               (ROW_WIDTH),
        .PARALLEL                (PARALLEL),
        .TAXELS                  (TAXELS),
        .FRACTION                (FRACTION),
        .U_LEFT                  (U_LEFT),
        .EXPECTED_VALUES_LATENCY (EXPECTED_VALUES_LATENCY),
        .EXPECTED_LATENCY        (EXPECTED_SEARCH_LATENCY)
    ) search (
        .clock       (clock),
        .reset       (reset),
        .u_valid     (u_valid),
        .u_orbit     (u_row),
        .u_values    (u_values),
        .fill_bank   (fill_bank),
        .search_bank (search_bank),
        .start       (search_start),
        .stress_sum  (search_stress_sum),
        .largest     (search_largest),
        .read_valid  (read_valid),
        .read_orbit  (read_orbit),
        .read_values (read_values),
        .done        (level_done),
        .mu_x        (found_x),
        .mu_y        (found_y),
        .unknown     (found_unknown),
        .at_bound    (found_on_border),
        .saturated   (found_saturated)
    );

    // ---- Standard error: during the search
    if (WITH_ERROR != 0) begin : gen_error
        sptfra_standard_error #(
            .MODEL    (ERROR_MODEL),
            .NOISE    (ERROR_NOISE),
            .BORDER   (ERROR_BORDER),
            .LARGEST  (ERROR_LARGEST),
            .AVERAGED (ERROR_AVERAGED)
        ) standard_error (
            .clock          (clock),
            .reset          (reset),
            .start          (search_start),
            .stress_sum     (stress_sum),
            .largest        (largest),
            .frame_exponent (exponent),
            .border         (border),
            .variance       (variance),
            .error_log      (found_error)
        );
    end else begin : gen_no_error
        assign found_error = 18'sd0;

        wire _unused_error = &{1'b0, border, variance, exponent, ERROR_MODEL, ERROR_NOISE, ERROR_BORDER,
            ERROR_LARGEST, ERROR_AVERAGED != 0};
    end

    // ---- Features and correction
    wire correction_done, clipped;
    wire signed [17:0] correction_x, correction_y;

    if (NETWORK != 0) begin : gen_correction
        localparam integer WORD_WIDTH = $clog2(LENGTH);
        wire input_valid, first_input;
        wire [WORD_WIDTH-1:0] input_word;
        wire [4*27-1:0] input_values;
        reg [WITH_FRAME-1:0] features_frame;

        assign seen = features_frame;
        always @(posedge clock) begin
            if (features_start) begin
                features_frame <= searched;
            end
        end

        sptfra_features #(
            .COLUMNS          (COLUMNS),
            .ROWS             (ROWS),
            .ROW_WIDTH        (ROW_WIDTH),
            .HALF_X           (HALF_X),
            .HALF_Y           (HALF_Y),
            .LENGTH           (LENGTH),
            .WORD_WIDTH       (WORD_WIDTH),
            .STRESS_LEFT      (STRESS_LEFT),
            .EXPECTED_LATENCY (EXPECTED_FEATURES_LATENCY)
        ) features (
            .clock          (clock),
            .reset          (reset),
            .start          (search_start),
            .stress_sum     (search_stress_sum),
            .read_valid     (read_valid),
            .read_orbit     (read_orbit),
            .read_values    (read_values),
            .features_start (features_start),
            .mu_x           (features_x),
            .mu_y           (features_y),
            .features_done  (centre_done),
            .saturated      (features_saturated),
            .window_start   (correction_start),
            .input_valid    (input_valid),
            .input_first    (first_input),
            .input_word     (input_word),
            .input_values   (input_values),
            .window_done    (window_done)
        );

        sptfra_network #(
            .LENGTH           (LENGTH),
            .WORD_WIDTH       (WORD_WIDTH),
            .PASSES           (PASSES),
            .AT_ONCE          (AT_ONCE),
            .UNIT_SHIFT       (UNIT_SHIFT),
            .CORRECTION_SHIFT (CORRECTION_SHIFT),
            .ROM_DIR          (ROM_DIR),
            .ROM_NAME         (ROM_NAME),
            .EXPECTED_LATENCY (EXPECTED_NETWORK_LATENCY)
        ) network (
            .clock        (clock),
            .reset        (reset),
            .input_valid  (input_valid),
            .input_word   (input_word),
            .input_values (input_values),
            .start        (first_input),
            .done         (correction_done),
            .correction_x (correction_x),
            .correction_y (correction_y)
        );
    end else begin : gen_none
        assign seen = searched;
        assign {centre_done, window_done, correction_done, features_saturated} = 4'd0;
        assign {correction_x, correction_y} = 36'd0;

        wire _unused = &{1'b0, features_start, features_x, features_y, read_valid, read_orbit, read_values,
            HALF_X != 0, HALF_Y != 0, LENGTH != 0, PASSES != 0, STRESS_LEFT != 0, UNIT_SHIFT != 0,
            CORRECTION_SHIFT != 0, EXPECTED_FEATURES_LATENCY != 0,
            EXPECTED_NETWORK_LATENCY != 0, AT_ONCE != 0, ROM_DIR == "", ROM_NAME == ""};
    end

    // ---- Friction
    sptfra_friction #(
        .CORRECTED        (NETWORK),
        .LINEAR           (LINEAR),
        .CUBIC            (CUBIC),
        .EXPECTED_LATENCY (EXPECTED_FRICTION_LATENCY)
    ) friction (
        .clock        (clock),
        .reset        (reset),
        .start        (correction_start),
        .centroid_x   (centroid_x),
        .centroid_y   (centroid_y),
        .unknown      (unknown),
        .corrected    (correction_done),
        .correction_x (correction_x),
        .correction_y (correction_y),
        .done         (search_done),
        .mu_x         (free),
        .mu_y         (other),
        .clipped      (clipped)
    );

    assign x_is_free = 1'b1;
    assign slope = 18'sd0;
    assign error_log = unknown ? 18'sd0 : frame_error; // without a direction as much as presses
    assign at_bound = on_border || clipped;
    assign saturated = before_saturated && !unknown;

    wire _unused = &{1'b0, direction_x, direction_y, no_direction}; // the direction of the push is not needed

endmodule

`default_nettype wire
