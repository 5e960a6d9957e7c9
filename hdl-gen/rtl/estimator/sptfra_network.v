// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Network of the correction: one hidden layer of rectifiers (ReLU), then two sums, averaged over mirror images.
//
// Input and weights stand in the basis of the parity components. One pass gives the four components' sums of AT_ONCE
// hidden units. A butterfly turns them into the units of the four images, one after the other. PASSES passes of LENGTH
// words, four MACs a unit. From start to done: a cycle for each word of each pass, one for each unit of one, and 14.

`default_nettype none

module sptfra_network #(
    // Words of inputs
    parameter integer LENGTH = 32,
    // Bits of a word's number
    parameter integer WORD_WIDTH = 5,
    // Passes, and hidden units in each, a power of two from 4 on
    parameter integer PASSES = 4,
    parameter integer AT_ONCE = 4,
    // Bits dropped from a component's sum
    parameter integer UNIT_SHIFT = 12,
    // Bits dropped from the sum of the output; negative: added
    parameter integer CORRECTION_SHIFT = 12,
    // Prefix of the ROM file names, for instance a directory with its slash
    parameter ROM_DIR = "",
    // Name of the ROM files, without what they hold
    parameter ROM_NAME = "",
    // From start to done, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0
) (
    input  wire clock,
    input  wire reset,
    // Inputs, component 0 in the lowest bits, 19 fraction bits each
    input  wire input_valid,
    input  wire [WORD_WIDTH-1:0] input_word,
    input  wire [4*27-1:0] input_values,
    input  wire start, // with the first of them; they come word by word, one a cycle
    // Result, held until the next start: within 1/4, 16 fraction bits
    output reg  done, // one cycle
    output reg  signed [17:0] correction_x,
    output reg  signed [17:0] correction_y
);

    localparam integer INPUT_BITS = 27;
    localparam integer UNIT_BITS = 26; // of a hidden unit before the rectifier
    localparam integer SUMS = 4 * AT_ONCE; // units by four components
    localparam integer UNITS = AT_ONCE * PASSES;
    localparam integer UNIT_WIDTH = $clog2(AT_ONCE);
    localparam integer SUMMING = AT_ONCE + 12; // from the last weight to the mean, before it is out
    localparam integer WEIGHTS = PASSES * LENGTH;
    localparam integer LAST_WORD = LENGTH - 1;
    localparam integer LAST_WEIGHT = WEIGHTS - 1;
    localparam integer WEIGHT_WIDTH = $clog2(WEIGHTS);
    localparam integer READOUT_WIDTH = $clog2(UNITS);
    localparam signed [47:0] UNIT_HALF = (UNIT_SHIFT == 0) ? 48'sd0 : 48'sd1 <<< (UNIT_SHIFT - 1);
    localparam integer RIGHT = (CORRECTION_SHIFT > 0) ? CORRECTION_SHIFT : 0;
    localparam integer LEFT = (CORRECTION_SHIFT < 0) ? -CORRECTION_SHIFT : 0;
    localparam signed [63:0] HALF = (RIGHT == 0) ? 64'sd0 : 64'sd1 <<< (RIGHT - 1);
    localparam signed [17:0] LIMIT = 18'sd16384; // 1/4
    localparam signed [63:0] WIDE_LIMIT = 64'sd16384;

    if ((AT_ONCE != 4) && (AT_ONCE != 8) && (AT_ONCE != 16)) begin : gen_check_units
        sptfra_error_4_8_or_16_hidden_units_are_worked_on_at_once invalid ();
    end
    if (LENGTH < AT_ONCE + 4) begin : gen_check_length
        sptfra_error_a_pass_is_too_short_to_read_out_the_one_before invalid ();
    end

    // ---- Walk over the weights
    reg running;
    reg [WORD_WIDTH-1:0] word;
    reg [WEIGHT_WIDTH-1:0] weight_address;
    wire last_word = (word == LAST_WORD[WORD_WIDTH-1:0]);
    wire last_weight = (weight_address == LAST_WEIGHT[WEIGHT_WIDTH-1:0]);
    reg valid_1;
    reg first_1;
    reg [4:1] pass_ends; // index k: k cycles after its last address
    wire [4*INPUT_BITS-1:0] values_1;
    wire [18*SUMS-1:0] weights_1;

    always @(posedge clock) begin
        if (running) begin
            word <= last_word ? {WORD_WIDTH{1'b0}} : word + 1'b1;
            weight_address <= weight_address + 1'b1;
            if (last_weight) begin
                running <= 1'b0;
            end
        end
        if (start) begin
            running <= 1'b1;
            word <= {WORD_WIDTH{1'b0}};
            weight_address <= {WEIGHT_WIDTH{1'b0}};
        end
        valid_1 <= running;
        first_1 <= (word == {WORD_WIDTH{1'b0}});
        pass_ends <= {pass_ends[3:1], running && last_word};
        if (reset) begin
            running <= 1'b0;
            valid_1 <= 1'b0;
            pass_ends <= 4'd0;
        end
    end

    sptfra_ram #(
        .WIDTH         (4 * INPUT_BITS),
        .DEPTH         (LENGTH),
        .ADDRESS_WIDTH (WORD_WIDTH)
    ) inputs (
        .clock         (clock),
        .write_enable  (input_valid),
        .write_address (input_word),
        .write_data    (input_values),
        .read_enable   (1'b1),
        .read_address  (word),
        .read_data     (values_1)
    );

    sptfra_rom #(
        .WIDTH         (18 * SUMS),
        .DEPTH         (WEIGHTS),
        .ADDRESS_WIDTH (WEIGHT_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_weights.mem"})
    ) weights (
        .clock         (clock),
        .enable        (1'b1),
        .address       (weight_address),
        .data          (weights_1)
    );

    // ---- Sums of the units by component, at index 4 unit + component; held while the next pass begins
    wire [UNIT_BITS*SUMS-1:0] component_sums;
    reg [UNIT_BITS*SUMS-1:0] held;
    genvar index;
    for (index = 0; index < SUMS; index = index + 1) begin : gen_sums
        wire signed [47:0] exact;
        wire signed [47:0] rounded = exact + UNIT_HALF;

        sptfra_mac weigh (
            .clock       (clock),
            .reset       (reset),
            .valid       (valid_1),
            .first       (first_1),
            .coefficient (weights_1[18*index +: 18]),
            .data        (values_1[INPUT_BITS*(index % 4) +: INPUT_BITS]),
            .accumulator (exact)
        );

        assign component_sums[UNIT_BITS*index +: UNIT_BITS] = rounded[UNIT_SHIFT +: UNIT_BITS];

        // The bits above are copies of the sign
        wire _unused = &{1'b0, rounded};
    end

    // ---- One unit after the other: the mirror images, their rectifiers, mirrored back
    reg [UNIT_WIDTH:0] unit; // AT_ONCE: none
    reg [5:1] unit_there; // index k: k cycles after its number
    reg [4*UNIT_BITS-1:0] components_1;
    wire [4*UNIT_BITS+7:0] images_3;
    wire [4*UNIT_BITS-1:0] rectifiers_3;
    wire [4*UNIT_BITS+7:0] mean_5;

    always @(posedge clock) begin
        if (pass_ends[4]) begin
            held <= component_sums;
            unit <= {(UNIT_WIDTH + 1){1'b0}};
        end else if (!unit[UNIT_WIDTH]) begin
            unit <= unit + 1'b1;
        end
        components_1 <= held[4*UNIT_BITS*unit[UNIT_WIDTH-1:0] +: 4*UNIT_BITS];
        unit_there <= {unit_there[4:1], !unit[UNIT_WIDTH]};
        if (reset) begin
            unit <= {1'b1, {UNIT_WIDTH{1'b0}}};
            unit_there <= 5'd0;
        end
    end

    sptfra_butterfly #(
        .WIDTH (UNIT_BITS)
    ) mirror (
        .clock  (clock),
        .enable (1'b1),
        .values (components_1),
        .sums   (images_3)
    );

    // The sum of a unit fits the width, by the plan's bound: the bits above are copies of the sign
    for (index = 0; index < 4; index = index + 1) begin : gen_rectifiers
        wire [UNIT_BITS+1:0] image = images_3[(UNIT_BITS+2)*index +: UNIT_BITS+2];
        wire negative = image[UNIT_BITS+1];

        assign rectifiers_3[UNIT_BITS*index +: UNIT_BITS] = negative ? {UNIT_BITS{1'b0}} : image[UNIT_BITS-1:0];

        wire _unused = &{1'b0, image[UNIT_BITS]};
    end

    sptfra_butterfly #(
        .WIDTH (UNIT_BITS)
    ) mirror_back (
        .clock  (clock),
        .enable (1'b1),
        .values (rectifiers_3),
        .sums   (mean_5)
    );

    // ---- Output: odd in x, and odd in y
    reg [READOUT_WIDTH-1:0] readout_address;
    reg first_5;
    wire [35:0] readout_5;
    wire signed [47:0] sum_x;
    wire signed [47:0] sum_y;
    wire signed [26:0] along_x_5 = mean_5[(UNIT_BITS+2)*1 +: 27];
    wire signed [26:0] along_y_5 = mean_5[(UNIT_BITS+2)*2 +: 27];

    sptfra_rom #(
        .WIDTH         (36),
        .DEPTH         (UNITS),
        .ADDRESS_WIDTH (READOUT_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_readout.mem"})
    ) readout (
        .clock         (clock),
        .enable        (1'b1),
        .address       (readout_address),
        .data          (readout_5)
    );

    sptfra_mac output_x (
        .clock       (clock),
        .reset       (reset),
        .valid       (unit_there[5]),
        .first       (first_5),
        .coefficient (readout_5[17:0]),
        .data        (along_x_5),
        .accumulator (sum_x)
    );

    sptfra_mac output_y (
        .clock       (clock),
        .reset       (reset),
        .valid       (unit_there[5]),
        .first       (first_5),
        .coefficient (readout_5[35:18]),
        .data        (along_y_5),
        .accumulator (sum_y)
    );

    always @(posedge clock) begin
        if (unit_there[4]) begin
            readout_address <= readout_address + 1'b1;
        end
        if (unit_there[5]) begin
            first_5 <= 1'b0;
        end
        if (start) begin
            readout_address <= {READOUT_WIDTH{1'b0}};
            first_5 <= 1'b1;
        end
    end

    // ---- The mean, within its limit
    reg summing; // until the last unit is in
    reg [4:0] wait_count;
    reg signed [63:0] exact_x;
    reg signed [63:0] exact_y;
    wire signed [63:0] wide_x = { {16{sum_x[47]}}, sum_x};
    wire signed [63:0] wide_y = { {16{sum_y[47]}}, sum_y};

    always @(posedge clock) begin
        done <= 1'b0;
        exact_x <= ((wide_x + HALF) >>> RIGHT) <<< LEFT;
        exact_y <= ((wide_y + HALF) >>> RIGHT) <<< LEFT;
        correction_x <= (exact_x > WIDE_LIMIT) ? LIMIT : (exact_x < -WIDE_LIMIT) ? -LIMIT : exact_x[17:0];
        correction_y <= (exact_y > WIDE_LIMIT) ? LIMIT : (exact_y < -WIDE_LIMIT) ? -LIMIT : exact_y[17:0];
        wait_count <= summing ? wait_count + 5'd1 : 5'd0;
        if (running && last_weight) begin
            summing <= 1'b1;
        end
        if (summing && (wait_count == SUMMING[4:0])) begin
            summing <= 1'b0;
            done <= 1'b1;
        end
        if (reset) begin
            summing <= 1'b0;
            done <= 1'b0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset),
        .start (start),
        .done  (done)
    );

    wire _unused = &{1'b0, mean_5};

endmodule

`default_nettype wire
