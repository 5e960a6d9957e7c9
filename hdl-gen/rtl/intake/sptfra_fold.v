// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Fold: a frame's stresses, kept as they come, to the PEs' operand memories as four parity components, or as they are.
//
// An orbit is a taxel and its mirror images in x, in y and in both. Its component c is their sum with the signs of a
// parity: even, odd in x, odd in y, odd in both. One orbit a cycle, those of the middle rows first, so that the
// frame's last taxel belongs to the last orbit. From an orbit's reading to its write: 4 cycles, with SCALED 6. A
// component has the bits of a stress and four times its step; or, where there is room for the sum of four, its step.

`default_nettype none

module sptfra_fold #(
    // Taxels in x and y, and of a beat
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter SAMPLES = 1,
    // 2: each taxel has a stress and an average of it; 1: a stress
    parameter CANDIDATES = 1,
    // 4: folded into parity components; 1: as they are, in the order of taxels
    parameter CHANNELS = 4,
    // Bits of a stress, and of a component: as many, or two more, or beyond
    parameter STRESS_BITS = 27,
    parameter DATA_BITS = 27,
    // 1: stresses are shifted by the frame's exponent first
    parameter SCALED = 0,
    // Derived
    parameter ELEMENTS = (CHANNELS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter BEATS = (COLUMNS * ROWS + SAMPLES - 1) / SAMPLES,
    parameter BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1,
    parameter COUNT_WIDTH = $clog2(BEATS + 1)
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // The frame as it comes
    input  wire beat_valid,
    input  wire [BEAT_WIDTH-1:0] beat,
    input  wire [CANDIDATES*SAMPLES*STRESS_BITS-1:0] stresses, // sample by sample, its candidates side by side
    input  wire averaged, // the frame is made of averages, from the first reading on
    input  wire [COUNT_WIDTH-1:0] written, // beats whose orbits may be read
    input  wire whole, // all orbits may
    input  wire [4:0] exponent, // two enabled cycles after the first reading
    output wire folded, // every orbit was read, until restart
    input  wire restart, // with the next frame
    // Operand memories
    output wire write_valid,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [CHANNELS*DATA_BITS-1:0] write_data, // component 0 in the lowest bits
    output wire frame_written // the frame is complete
);

    localparam SUM_BITS = (CHANNELS == 4) ? STRESS_BITS + 2 : STRESS_BITS;
    localparam DROPPED = (DATA_BITS < SUM_BITS) ? 2 : 0; // bits of a sum
    localparam READ_TO_WRITTEN = (SCALED != 0) ? 6 : 4; // cycles, which simulations check of a frame that flows
    localparam SAMPLE_WIDTH = $clog2(SAMPLES);
    localparam INDEX_WIDTH = BEAT_WIDTH + SAMPLE_WIDTH;
    localparam ORBIT_COLUMNS = (CHANNELS == 4) ? (COLUMNS + 1) / 2 : COLUMNS;
    localparam ORBIT_ROWS = (CHANNELS == 4) ? (ROWS + 1) / 2 : ROWS;
    localparam ORBIT_X_WIDTH = (ORBIT_COLUMNS > 2) ? $clog2(ORBIT_COLUMNS) : 1;
    // Beats with taxels of the upper half, and the first one with taxels of the lower half
    localparam UPPER_BEATS = (ORBIT_ROWS * COLUMNS + SAMPLES - 1) / SAMPLES;
    localparam LOWER_BEAT = ((ROWS - ORBIT_ROWS) * COLUMNS) / SAMPLES;
    localparam LOWER_FIRST = (ROWS - ORBIT_ROWS) * COLUMNS - LOWER_BEAT * SAMPLES;
    // Taxels of the first orbit, on the left and on the right of the upper and of the lower half
    localparam [31:0] FIRST_UPPER_LEFT = (ORBIT_ROWS - 1) * COLUMNS + ORBIT_COLUMNS - 1;
    localparam [31:0] FIRST_UPPER_RIGHT = (ORBIT_ROWS - 1) * COLUMNS + COLUMNS - ORBIT_COLUMNS;
    localparam [31:0] FIRST_LOWER_LEFT = LOWER_FIRST + ORBIT_COLUMNS - 1;
    localparam [31:0] FIRST_LOWER_RIGHT = LOWER_FIRST + COLUMNS - ORBIT_COLUMNS;
    // From the last orbit of a row to the first of the next one
    localparam [31:0] ROW_UPPER_LEFT = ORBIT_COLUMNS - 1 - COLUMNS;
    localparam [31:0] ROW_UPPER_RIGHT = 1 - ORBIT_COLUMNS - COLUMNS;
    localparam [31:0] ROW_LOWER_LEFT = ORBIT_COLUMNS - 1 + COLUMNS;
    localparam [31:0] ROW_LOWER_RIGHT = 1 - ORBIT_COLUMNS + COLUMNS;
    localparam [31:0] FIRST_ORBIT = ELEMENTS - 1;
    localparam [31:0] FIRST_ORBIT_X = ORBIT_COLUMNS - 1;
    localparam [31:0] LOWER_BEAT_WIDE = LOWER_BEAT;
    localparam [INDEX_WIDTH-1:0] ONE = {{(INDEX_WIDTH-1){1'b0}}, 1'b1};

    // ---- The orbit that is read, and its taxels
    reg done;
    reg [ROW_WIDTH-1:0] orbit;
    reg [ORBIT_X_WIDTH-1:0] orbit_x;
    reg [INDEX_WIDTH-1:0] upper_left;
    reg [INDEX_WIDTH-1:0] upper_right;
    reg [INDEX_WIDTH-1:0] lower_left;
    reg [INDEX_WIDTH-1:0] lower_right; // the last of them in the frame
    wire last_orbit = (orbit == {ROW_WIDTH{1'b0}});
    wire row_ends = (orbit_x == {ORBIT_X_WIDTH{1'b0}});
    wire [31:0] beat_needed = {{(32-BEAT_WIDTH){1'b0}}, lower_right[SAMPLE_WIDTH +: BEAT_WIDTH]} + LOWER_BEAT_WIDE;
    wire [31:0] beats_there = {{(32-COUNT_WIDTH){1'b0}}, written};
    // The last one waits for the frame's end, wherever that is
    wire read = (whole || (!last_orbit && (beat_needed < beats_there))) && !done && advance;

    assign folded = done;

    always @(posedge clock) begin
        if (read) begin
            done <= last_orbit;
            orbit <= orbit - 1'b1;
            if (row_ends) begin
                orbit_x <= FIRST_ORBIT_X[ORBIT_X_WIDTH-1:0];
                upper_left <= upper_left + ROW_UPPER_LEFT[INDEX_WIDTH-1:0];
                upper_right <= upper_right + ROW_UPPER_RIGHT[INDEX_WIDTH-1:0];
                lower_left <= lower_left + ROW_LOWER_LEFT[INDEX_WIDTH-1:0];
                lower_right <= lower_right + ROW_LOWER_RIGHT[INDEX_WIDTH-1:0];
            end else begin
                orbit_x <= orbit_x - 1'b1;
                upper_left <= upper_left - ONE;
                upper_right <= upper_right + ONE;
                lower_left <= lower_left - ONE;
                lower_right <= lower_right + ONE;
            end
        end
        if (reset || restart) begin
            done <= 1'b0;
            orbit <= FIRST_ORBIT[ROW_WIDTH-1:0];
            orbit_x <= FIRST_ORBIT_X[ORBIT_X_WIDTH-1:0];
            upper_left <= FIRST_UPPER_LEFT[INDEX_WIDTH-1:0];
            upper_right <= FIRST_UPPER_RIGHT[INDEX_WIDTH-1:0];
            lower_left <= FIRST_LOWER_LEFT[INDEX_WIDTH-1:0];
            lower_right <= FIRST_LOWER_RIGHT[INDEX_WIDTH-1:0];
        end
    end

    // ---- Its stresses, from a copy of half the frame for each of its taxels; then in the frame's scale
    wire [4*INDEX_WIDTH-1:0] taxels = {lower_left, upper_right, upper_left, lower_right};
    wire [CHANNELS*STRESS_BITS-1:0] shifted;
    genvar image;

    for (image = 0; image < CHANNELS; image = image + 1) begin : gen_images
        localparam UPPER = ((image == 1) || (image == 2)) ? 1 : 0;
        wire [CANDIDATES*STRESS_BITS-1:0] both_2;
        wire [STRESS_BITS-1:0] kept_2
            = averaged ? both_2[(CANDIDATES-1)*STRESS_BITS +: STRESS_BITS] : both_2[STRESS_BITS-1:0];

        sptfra_frame_memory #(
            .SAMPLES (SAMPLES),
            .BEATS   (BEATS),
            .FIRST   ((UPPER != 0) ? 0 : LOWER_BEAT),
            .KEPT    ((UPPER != 0) ? UPPER_BEATS : BEATS - LOWER_BEAT),
            .WIDTH   (CANDIDATES * STRESS_BITS)
        ) frame (
            .clock          (clock),
            .write_enable   (beat_valid),
            .write_beat     (beat),
            .write_stresses (stresses),
            .read_enable    (advance),
            .taxel          (taxels[INDEX_WIDTH*image +: INDEX_WIDTH]),
            .stress         (both_2)
        );

        if (SCALED != 0) begin : gen_scale
            reg [STRESS_BITS-1:0] octets_3;
            reg [STRESS_BITS-1:0] exact_4;

            assign shifted[STRESS_BITS*image +: STRESS_BITS] = exact_4;

            always @(posedge clock) begin
                if (advance) begin
                    octets_3 <= kept_2 << {exponent[4:3], 3'd0};
                    exact_4 <= octets_3 << exponent[2:0];
                end
            end
        end else begin : gen_as_read
            assign shifted[STRESS_BITS*image +: STRESS_BITS] = kept_2;
        end
    end
    if (SCALED == 0) begin : gen_unscaled
        wire _unused_exponent = &{1'b0, exponent};
    end

    // ---- Mirror in x, mirror in y: two cycles. On a centre line both are the same taxel
    wire [CHANNELS*SUM_BITS-1:0] sums;

    if (CHANNELS == 4) begin : gen_components
        // Half a step of the result is added, for the rounding
        sptfra_butterfly #(
            .WIDTH (STRESS_BITS),
            .HALF  (DROPPED)
        ) butterfly (
            .clock  (clock),
            .enable (advance),
            .values ({shifted[0 +: STRESS_BITS], shifted[STRESS_BITS +: 3*STRESS_BITS]}),
            .sums   (sums)
        );
    end else begin : gen_taxels
        reg [2*SUM_BITS-1:0] held;

        assign sums = held[SUM_BITS +: SUM_BITS];

        always @(posedge clock) begin
            if (advance) begin
                held <= {held[SUM_BITS-1:0], shifted};
            end
        end

        wire _unused_images = &{1'b0, taxels};
    end

    // ---- Write
    reg [READ_TO_WRITTEN:1] valid;
    reg [READ_TO_WRITTEN:1] lasts;
    reg [ROW_WIDTH*READ_TO_WRITTEN-1:0] rows;
    reg bank;
    genvar parity;
    genvar place;

    assign write_valid = valid[READ_TO_WRITTEN];
    assign write_bank = bank;
    assign write_row = rows[ROW_WIDTH*READ_TO_WRITTEN-1 -: ROW_WIDTH];
    assign frame_written = lasts[READ_TO_WRITTEN] && advance;

    always @(posedge clock) begin
        if (advance) begin
            valid <= {valid[READ_TO_WRITTEN-1:1], read};
            lasts <= {lasts[READ_TO_WRITTEN-1:1], read && last_orbit};
            rows <= {rows[ROW_WIDTH*(READ_TO_WRITTEN-1)-1:0],
                (CHANNELS == 4) ? orbit : FIRST_ORBIT[ROW_WIDTH-1:0] - orbit};
        end
        if (frame_written) begin
            bank <= !bank;
        end
        if (reset) begin
            valid <= {READ_TO_WRITTEN{1'b0}};
            lasts <= {READ_TO_WRITTEN{1'b0}};
            bank <= 1'b0;
        end
    end

    for (parity = 0; parity < CHANNELS; parity = parity + 1) begin : gen_results
        for (place = 0; place < DATA_BITS; place = place + 1) begin : gen_bits
            localparam OF_SUM = (place + DROPPED < SUM_BITS) ? place + DROPPED : SUM_BITS - 1;

            assign write_data[DATA_BITS*parity+place] = sums[SUM_BITS*parity+OF_SUM];
        end
    end

    sptfra_check_latency #(
        .CYCLES (READ_TO_WRITTEN)
    ) check_latency (
        .clock (clock),
        .reset (reset || !advance),
        .start (read && last_orbit),
        .done  (frame_written)
    );

    wire _unused = &{1'b0, sums};

endmodule

`default_nettype wire
