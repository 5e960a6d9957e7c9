// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Folds the stresses of a frame into the four parity classes of the lanes' operand memories, as sptfra_fold does, from
// beats of several taxels: each quad is read as soon as the last of its taxels is there.
//
// One quad a cycle, those of the middle rows first: so the last taxel of the frame belongs to the last quad. From a
// quad's turn to its write: 4 cycles.

`default_nettype none

module sptfra_fold_frame #(
    // Taxels in x and y, and of a beat
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter SAMPLES = 4,
    // Bits of a stress, and of a class: as many, or two more, or beyond
    parameter STRESS_BITS = 27,
    parameter DATA_BITS = 27,
    // Derived
    parameter QUADS = ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (QUADS > 8) ? $clog2(QUADS) : 3,
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
    input  wire [SAMPLES*STRESS_BITS-1:0] stresses,
    input  wire [COUNT_WIDTH-1:0] written, // beats of the frame that are there
    input  wire ended, // all that come
    output wire folded, // every quad had its turn, until restart
    input  wire restart, // with the next frame
    // Operand memories
    output wire write_valid,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_quad,
    output wire [4*DATA_BITS-1:0] write_data, // class 0 in the lowest bits
    output wire frame_written // the frame is complete
);

    localparam SUM_BITS = STRESS_BITS + 2;
    localparam DROPPED = (DATA_BITS < SUM_BITS) ? 2 : 0; // bits of a sum
    localparam TURN_TO_WRITTEN = 4; // cycles, which simulations check of a frame that flows
    localparam SAMPLE_WIDTH = $clog2(SAMPLES);
    localparam INDEX_WIDTH = BEAT_WIDTH + SAMPLE_WIDTH;
    localparam QUAD_COLUMNS = (COLUMNS + 1) / 2;
    localparam QUAD_ROWS = (ROWS + 1) / 2;
    localparam QUAD_X_WIDTH = (QUAD_COLUMNS > 2) ? $clog2(QUAD_COLUMNS) : 1;
    // Taxels of the first quad, on the left and on the right of the upper and of the lower half
    localparam [31:0] FIRST_UPPER_LEFT = (QUAD_ROWS - 1) * COLUMNS + QUAD_COLUMNS - 1;
    localparam [31:0] FIRST_UPPER_RIGHT = (QUAD_ROWS - 1) * COLUMNS + COLUMNS - QUAD_COLUMNS;
    localparam [31:0] FIRST_LOWER_LEFT = (ROWS - QUAD_ROWS) * COLUMNS + QUAD_COLUMNS - 1;
    localparam [31:0] FIRST_LOWER_RIGHT = (ROWS - QUAD_ROWS) * COLUMNS + COLUMNS - QUAD_COLUMNS;
    // From the last quad of a row to the first of the next one
    localparam [31:0] ROW_UPPER_LEFT = QUAD_COLUMNS - 1 - COLUMNS;
    localparam [31:0] ROW_UPPER_RIGHT = 1 - QUAD_COLUMNS - COLUMNS;
    localparam [31:0] ROW_LOWER_LEFT = QUAD_COLUMNS - 1 + COLUMNS;
    localparam [31:0] ROW_LOWER_RIGHT = 1 - QUAD_COLUMNS + COLUMNS;
    localparam [31:0] FIRST_QUAD = QUADS - 1;
    localparam [31:0] FIRST_QUAD_X = QUAD_COLUMNS - 1;
    localparam [INDEX_WIDTH-1:0] ONE = {{(INDEX_WIDTH-1){1'b0}}, 1'b1};

    // ---- Whose turn it is: the quad and its taxels
    reg done;
    reg [ROW_WIDTH-1:0] quad;
    reg [QUAD_X_WIDTH-1:0] quad_x;
    reg [INDEX_WIDTH-1:0] upper_left;
    reg [INDEX_WIDTH-1:0] upper_right;
    reg [INDEX_WIDTH-1:0] lower_left;
    reg [INDEX_WIDTH-1:0] lower_right; // the last of them in the frame
    wire last_quad = (quad == {ROW_WIDTH{1'b0}});
    wire row_ends = (quad_x == {QUAD_X_WIDTH{1'b0}});
    wire [31:0] beat_needed = {{(32-BEAT_WIDTH){1'b0}}, lower_right[SAMPLE_WIDTH +: BEAT_WIDTH]};
    wire [31:0] beats_there = {{(32-COUNT_WIDTH){1'b0}}, written};
    // The last one waits for the frame's end, wherever that is
    wire there = ended || (!last_quad && (beat_needed < beats_there));
    wire turn = there && !done && advance;

    assign folded = done;

    always @(posedge clock) begin
        if (turn) begin
            done <= last_quad;
            quad <= quad - 1'b1;
            if (row_ends) begin
                quad_x <= FIRST_QUAD_X[QUAD_X_WIDTH-1:0];
                upper_left <= upper_left + ROW_UPPER_LEFT[INDEX_WIDTH-1:0];
                upper_right <= upper_right + ROW_UPPER_RIGHT[INDEX_WIDTH-1:0];
                lower_left <= lower_left + ROW_LOWER_LEFT[INDEX_WIDTH-1:0];
                lower_right <= lower_right + ROW_LOWER_RIGHT[INDEX_WIDTH-1:0];
            end else begin
                quad_x <= quad_x - 1'b1;
                upper_left <= upper_left - ONE;
                upper_right <= upper_right + ONE;
                lower_left <= lower_left - ONE;
                lower_right <= lower_right + ONE;
            end
        end
        if (reset || restart) begin
            done <= 1'b0;
            quad <= FIRST_QUAD[ROW_WIDTH-1:0];
            quad_x <= FIRST_QUAD_X[QUAD_X_WIDTH-1:0];
            upper_left <= FIRST_UPPER_LEFT[INDEX_WIDTH-1:0];
            upper_right <= FIRST_UPPER_RIGHT[INDEX_WIDTH-1:0];
            lower_left <= FIRST_LOWER_LEFT[INDEX_WIDTH-1:0];
            lower_right <= FIRST_LOWER_RIGHT[INDEX_WIDTH-1:0];
        end
    end

    // ---- Stages 1 and 2: its stresses, from a copy of the frame for each of its members
    wire [4*INDEX_WIDTH-1:0] taxels = {lower_right, lower_left, upper_right, upper_left};
    wire signed [STRESS_BITS-1:0] stress_2 [0:3];
    genvar member;

    generate
        for (member = 0; member < 4; member = member + 1) begin : gen_members
            sptfra_frame_memory #(
                .TAXELS  (COLUMNS * ROWS),
                .SAMPLES (SAMPLES),
                .WIDTH   (STRESS_BITS)
            ) frame (
                .clock          (clock),
                .write_enable   (beat_valid),
                .write_beat     (beat),
                .write_stresses (stresses),
                .read_enable    (advance),
                .taxel          (taxels[INDEX_WIDTH*member +: INDEX_WIDTH]),
                .stress         (stress_2[member])
            );
        end
    endgenerate

    // ---- Stages 3 and 4: mirror in x, mirror in y. On a centre line both are the same taxel
    localparam signed [SUM_BITS-1:0] HALF = DROPPED; // half a step of the result, for the rounding
    wire signed [STRESS_BITS-1:0] a = stress_2[0];
    wire signed [STRESS_BITS-1:0] b = stress_2[1];
    wire signed [STRESS_BITS-1:0] c = stress_2[2];
    wire signed [STRESS_BITS-1:0] d = stress_2[3];
    reg [4:1] valid;
    reg [4:1] lasts;
    reg [4*ROW_WIDTH-1:0] quads;
    reg signed [STRESS_BITS:0] upper_even;
    reg signed [STRESS_BITS:0] upper_odd;
    reg signed [STRESS_BITS:0] lower_even;
    reg signed [STRESS_BITS:0] lower_odd;
    wire signed [SUM_BITS-1:0] even_above = {upper_even[STRESS_BITS], upper_even};
    wire signed [SUM_BITS-1:0] odd_above = {upper_odd[STRESS_BITS], upper_odd};
    wire signed [SUM_BITS-1:0] even_below = {lower_even[STRESS_BITS], lower_even};
    wire signed [SUM_BITS-1:0] odd_below = {lower_odd[STRESS_BITS], lower_odd};
    reg signed [SUM_BITS-1:0] sum_0;
    reg signed [SUM_BITS-1:0] sum_1;
    reg signed [SUM_BITS-1:0] sum_2;
    reg signed [SUM_BITS-1:0] sum_3;
    reg bank;

    always @(posedge clock) begin
        if (advance) begin
            valid <= {valid[3:1], turn};
            lasts <= {lasts[3:1], turn && last_quad};
            quads <= {quads[3*ROW_WIDTH-1:0], quad};
            upper_even <= {a[STRESS_BITS-1], a} + {b[STRESS_BITS-1], b};
            upper_odd <= {a[STRESS_BITS-1], a} - {b[STRESS_BITS-1], b};
            lower_even <= {c[STRESS_BITS-1], c} + {d[STRESS_BITS-1], d};
            lower_odd <= {c[STRESS_BITS-1], c} - {d[STRESS_BITS-1], d};
            sum_0 <= even_above + even_below + HALF;
            sum_1 <= odd_above + odd_below + HALF;
            sum_2 <= even_above - even_below + HALF;
            sum_3 <= odd_above - odd_below + HALF;
        end
        if (frame_written) begin
            bank <= !bank;
        end
        if (reset) begin
            valid <= 4'd0;
            lasts <= 4'd0;
            bank <= 1'b0;
        end
    end

    assign write_valid = valid[4];
    assign write_bank = bank;
    assign write_quad = quads[3*ROW_WIDTH +: ROW_WIDTH];
    assign frame_written = lasts[4] && advance;

    wire [4*SUM_BITS-1:0] sums = {sum_3, sum_2, sum_1, sum_0};
    genvar parity;
    genvar place;
    generate
        for (parity = 0; parity < 4; parity = parity + 1) begin : gen_classes
            for (place = 0; place < DATA_BITS; place = place + 1) begin : gen_bits
                localparam OF_SUM = (place + DROPPED < SUM_BITS) ? place + DROPPED : SUM_BITS - 1;

                assign write_data[DATA_BITS*parity+place] = sums[SUM_BITS*parity+OF_SUM];
            end
        end
    endgenerate

    sptfra_check_latency #(
        .CYCLES (TURN_TO_WRITTEN)
    ) check_latency (
        .clock (clock),
        .reset (reset || !advance),
        .start (turn && last_quad),
        .done  (frame_written)
    );

    wire _unused = &{1'b0, sums};

endmodule

`default_nettype wire
